// The cross-section of the street, and the ground beside it. Internal to kernel/surroundings.
//
// The street runs along the X axis of a frame whose origin is the middle of the pile on the ground.
#pragma once

#include <cstdint>

#include "kernel/base/random.h"
#include "kernel/surroundings/parts.h"

namespace rubble {

// RASt 06, the German guideline for streets in towns: carriageway 6.5 m, parking lanes 2.0 m, pavements
// 2.5 m; kerbs stand 0.12 m above the gutter; 2.5 % fall to the sides.
struct StreetSection {
  double circle = 10;  // radius of what is kept free; unit: m
  static constexpr double kLanes = 6.5 / 2, kParking = 2.0, kKerb = 0.15, kPavement = 2.5;  // unit: m
  static constexpr double kGutter = 0.02, kUpstand = 0.12, kFall = 0.025;  // unit: m, m and 1
  static constexpr double kHalf = kLanes + kParking;                       // to the kerb; unit: m
  static constexpr double kBack = kGutter + kUpstand + kFall * kPavement;  // height of a pavement's back; unit: m
  // The middle of the street, and where its pavements end towards the pile and away from it.
  double middle() const { return near_edge() - kPavement - kHalf; }
  double near_edge() const { return -circle - 0.5; }
  double far_edge() const { return middle() - kHalf - kPavement; }
};

// Heights of the ground beside the street; z = 0 within the circle.
class RoughGround {
 public:
  RoughGround(const StreetSection& street, std::uint64_t seed) : street_(street), seed_(seed) {}
  double height(double x, double y) const;
  double noise(double x, double y, double size, std::uint32_t number) const;  // -1 to 1

 private:
  StreetSection street_;
  std::uint64_t seed_;
};

SurroundingMesh make_road(const StreetSection& street, double reach, RandomStream& random);
SurroundingMesh make_road_patches(const StreetSection& street, double reach, RandomStream& random);
SurroundingMesh make_kerbs(const StreetSection& street, double reach, RandomStream& random);
SurroundingMesh make_pavements(const StreetSection& street, double reach, RandomStream& random);
SurroundingMesh make_soil(const StreetSection& street, const RoughGround& ground, double reach);
// Without levels where there are none.
SurroundingMesh make_tufts(const StreetSection& street, const RoughGround& ground, double reach, RandomStream& random);
// share: of the places for puddles that have one.
SurroundingMesh make_puddles(const StreetSection& street, double reach, double share, RandomStream& random);
SurroundingMesh make_hills(const RoughGround& ground, double from);

}  // namespace rubble
