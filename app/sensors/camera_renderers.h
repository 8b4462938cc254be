// The renderers that draw the cameras of a mission: one for each quality of colours among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/gl/gl_context.h"
#include "render/rays/depth_rays.h"
#include "render/renderer.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

struct CameraRendering {
  int threads = 1;
  Renderer::Progress on_light;           // progress of the light of all, from 0 to 1
  std::function<void(double)> on_image;  // of a path-traced image; may throw to stop
};

// The scene, lit for these colours, on the device of `gl`.
std::unique_ptr<Renderer> prepare_renderer(const Scene& scene, const ColourSpec& colour, GlContext& gl,
                                           const CameraRendering& options);

class CameraRenderers {
 public:
  // drawn: numbers of the cameras that will be drawn; empty: all. The context must outlive this. Throws RunError as Renderer
  // does.
  CameraRenderers(const Scene& scene, const std::vector<MountedCamera>& cameras, const std::vector<std::size_t>& drawn,
                  GlContext& gl, const CameraRendering& options);

  // Of one of the cameras that are drawn.
  Renderer& of(std::size_t camera) { return *renderers_[of_camera_.at(camera)]; }
  // Of the scene, the same for all.
  const Medium& medium() const { return renderers_.front()->medium(); }

 private:
  std::vector<std::unique_ptr<Renderer>> renderers_;
  std::vector<std::size_t> of_camera_;  // numbers of renderers
};

// Planar depth of a camera by exact rays: what a function that drives a robot is told, and what is recorded then.
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
