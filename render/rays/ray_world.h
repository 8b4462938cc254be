// What rays of any sensor meet: the exact triangles of the pieces at their finest, and the ground z = 0.
//
// Between two times what moves goes along a straight line with a constant turn, so that each ray meets it where it is at
// the ray's own time. Positions are single precision: near the pile a surface is within 1e-6 m of that of pile.stl. Hits
// have the same bits on every machine (geometry/ray_tree.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "render/scene/scene.h"

namespace rubble {

class RayWorld {
 public:
  struct Ray {
    Vec3 from;       // unit: m
    Vec3 direction;  // unit length
    float time = 0;  // from 0 to 1, between the two times of span()
  };
  struct Hit {
    double distance = -1;    // unit: m; negative: none
    float cosine = 0;        // of the angle at which the surface is met
    float reflectance = 0;   // share of light just beyond red that it throws back; range: 0 to 1
    std::int32_t piece = -1;  // SceneInstance::id; -1: the ground, or nothing
  };

  // Casts eight rays at most at once.
  static constexpr std::size_t kPacket = 8;

  // Keeps what moves in the scene, not the scene. Throws RunError: unknown look, out of memory.
  explicit RayWorld(const Scene& scene);
  ~RayWorld();

  bool moves() const;
  // From when to when the rays that follow are cast. Not while another thread casts. What is not there
  // at both times is not there between them.
  void span(std::int64_t from_ns, std::int64_t to_ns);
  // hits[i] is what rays[i] meets first, not farther than max_distance. May be called by several
  // threads; the answer for a ray depends on the rays beside it in no way.
  void cast(const Ray* rays, std::size_t count, double max_distance, Hit* hits) const;
  // The same, of a hit no more than its distance and, unless null, its piece.
  void cast(const Ray* rays, std::size_t count, double max_distance, double* distances, std::int32_t* pieces) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace rubble
