#include "app/sensors/camera_renderers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/system/disk_cache.h"

namespace rubble {
namespace {

// Whether one renderer draws both: samples and the filter are of path tracing alone.
bool draws_alike(const ColourSpec& a, const ColourSpec& b) {
  if (a.quality != b.quality) return false;
  return a.quality != RenderQuality::reference || (a.samples == b.samples && a.denoise == b.denoise);
}

}  // namespace

std::unique_ptr<Renderer> prepare_renderer(const Scene& scene, const ColourSpec& colour, GlContext& gl,
                                           const CameraRendering& options) {
  RenderOptions of;
  of.threads = options.threads;
  of.colour = colour;
  of.image_progress = options.on_image;
  of.cache_folder = DiskCache::usual_folder();
  return std::make_unique<Renderer>(gl, scene, of, options.on_light);
}

CameraRenderers::CameraRenderers(const Scene& scene, const std::vector<MountedCamera>& cameras,
                                 const std::vector<std::size_t>& drawn, GlContext& gl, const CameraRendering& options)
    : of_camera_(cameras.size(), cameras.size()) {
  std::vector<ColourSpec> colours;
  for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
    if (!drawn.empty() && std::find(drawn.begin(), drawn.end(), camera) == drawn.end()) continue;
    const ColourSpec& colour = cameras[camera].camera.colour;
    const auto same = std::find_if(colours.begin(), colours.end(), [&](const ColourSpec& c) { return draws_alike(c, colour); });
    of_camera_[camera] = std::size_t(same - colours.begin());
    if (same == colours.end()) colours.push_back(colour);
  }
  for (const ColourSpec& colour : colours) {
    CameraRendering one = options;
    if (options.on_light)
      one.on_light = [&, done = double(renderers_.size())](double share) {
        options.on_light((done + share) / double(colours.size()));
      };
    renderers_.push_back(prepare_renderer(scene, colour, gl, one));
  }
}

namespace {

constexpr double kFarthest = 1000;  // along a ray; unit: m

DepthRays make_rays(const MountedCamera& camera) {
  const Intrinsics k = camera.camera.intrinsics();
  const bool straight = std::all_of(k.distortion.begin(), k.distortion.end(), [](double d) { return d == 0; });
  if (camera.camera.lens.model == LensKind::fisheye || !straight)
    throw InputError({"", 0, camera.key() + ".lens", "a controller cannot use this camera",
                      "a pinhole", "a lens with distortion", "add a second camera without `lens` for the controller"});
  return DepthRays(k, kFarthest);
}

}  // namespace

ExactDepth::ExactDepth(const MountedCamera& camera, std::shared_ptr<RayWorld> world, int threads)
    : rays_(make_rays(camera)), world_(std::move(world)), pool_(threads) {}

std::vector<float> ExactDepth::measure(std::int64_t stamp_ns, const Pose& world_from_camera) {
  const Intrinsics& k = rays_.intrinsics();
  std::vector<float> depth(std::size_t(k.width) * std::size_t(k.height));
  world_->span(stamp_ns, stamp_ns);
  rays_.cast(*world_, world_from_camera, pool_, depth.data());
  for (float& d : depth)
    if (std::isinf(d)) d = std::numeric_limits<float>::quiet_NaN();
  return depth;
}

}  // namespace rubble
