// Planar depth of a camera by exact rays: what a function that drives a robot is told, and what is recorded then.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/rays/depth_rays.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

class ExactDepth {
 public:
  // Throws InputError for a lens that is no pinhole.
  ExactDepth(const MountedCamera& camera, std::shared_ptr<RayWorld> world, int threads);

  const Intrinsics& intrinsics() const { return rays_.intrinsics(); }
  // As Frame::depth, of everything where it is at that stamp.
  std::vector<float> measure(std::int64_t stamp_ns, const Pose& world_from_camera);

 private:
  DepthRays rays_;
  std::shared_ptr<RayWorld> world_;
  ThreadPool pool_;
};

}  // namespace rubble
