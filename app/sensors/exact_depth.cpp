#include "app/sensors/exact_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/base/error.h"

namespace rubble {
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
