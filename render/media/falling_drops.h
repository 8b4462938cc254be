// The single drops or flakes about a camera: where each is at any time, in the world.
//
// Every class of sizes fills space with copies of one cube of drops, whose side is twice the distance to which
// the class is drawn; of each drop one copy is about the eye. It moves with the wind and its own terminal speed
// along a straight line, so that cameras, eyes and frames see the same drops. How many a cube has is drawn
// from Poisson's distribution; places are uniform. All follows from the seed.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "render/media/precipitation.h"

namespace rubble {

struct Drop {
  Vec3 place;           // in the world; unit: m
  Vec3 velocity;        // unit: m/s
  double diameter = 0;  // as seen; unit: m
};

class FallingDrops {
 public:
  FallingDrops(const Precipitation& precipitation, const Vec3& wind, std::uint64_t seed);

  const Precipitation& precipitation() const { return precipitation_; }
  // All that are drawn from there, in an order that the threads do not change. facing: unit vector; cosine: of the
  // angle from it beyond which nothing is asked for; nearest: none nearer than that; unit: m
  std::vector<Drop> about(const Vec3& eye, const Vec3& facing, double cosine, double nearest, double seconds,
                          int threads) const;

 private:
  struct Seed {
    Vec3f place;     // in the cube, at time zero; unit: m
    float diameter;  // melted; unit: mm
  };
  struct Class {
    double side = 0;  // of the cube; unit: m
    std::vector<Seed> drops;
  };

  Precipitation precipitation_;
  Vec3 wind_;
  std::vector<Class> classes_;
};

}  // namespace rubble
