// Planar depth of a pinhole camera by exact rays: for loops that want many small pictures and no light.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/parallel.h"
#include "render/rays/ray_world.h"
#include "render/scene/frame.h"

namespace rubble {

class DepthRays {
 public:
  // k: a plain pinhole; its distortion is not looked at. max_range: along the ray; unit: m.
  DepthRays(const Intrinsics& k, double max_range);

  // depth: width * height values, row by row: metres along the optical axis, infinite where nothing is within
  // max_range. pieces: likewise, as RayWorld::Hit::piece; null: not asked for. The result does not depend on
  // the threads.
  void cast(const RayWorld& world, const Pose& world_from_camera, ThreadPool& pool, float* depth,
            std::int32_t* pieces = nullptr) const;

  const Intrinsics& intrinsics() const { return k_; }
  // Of a pixel's ray in the camera's body, unit length; planar depth over distance along it.
  const Vec3& direction(std::size_t pixel) const { return directions_[pixel]; }
  double cosine(std::size_t pixel) const { return cosines_[pixel]; }

 private:
  Intrinsics k_;
  double max_range_;
  std::vector<Vec3> directions_;
  std::vector<double> cosines_;
  std::vector<std::uint32_t> order_;  // of the pixels that are cast: those beside each other together
};

}  // namespace rubble
