#include "render/sensors/motion.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr double kInfinity = 1e6;  // unit: m; where the sky is
constexpr int kStep = 4;

Vec3 shifted(const Vec3& world, const MomentNearby& moment, std::size_t pixel) {
  return moment.shifts.empty() ? world : world + Vec3(moment.shifts[pixel]);
}

}  // namespace

double longest_motion(const ViewRays& view, const std::vector<float>& distances,
                      const MomentNearby& first, const MomentNearby& last) {
  const Intrinsics& k = view.intrinsics;
  const Lens lens(k);
  const Pose before = (first.world_from_camera * camera_from_optical).inverse();
  const Pose after = (last.world_from_camera * camera_from_optical).inverse();
  const auto inside = [&](const PixelPoint& p) {
    return p.u > -1 && p.v > -1 && p.u < k.width && p.v < k.height;
  };
  double longest = 0;
  for (int v = kStep / 2; v < k.height; v += kStep) {
    const Pose pose = view.pose(v);
    for (int u = kStep / 2; u < k.width; u += kStep) {
      const Vec3 d = view.direction(u, v);
      if (d == Vec3()) continue;
      const std::size_t i = std::size_t(v) * std::size_t(k.width) + std::size_t(u);
      const double distance = double(distances[i]);
      const Vec3 world = pose * (d * (std::isnan(distance) ? kInfinity : distance));
      const auto a = lens.project(before * shifted(world, first, i));
      const auto b = lens.project(after * shifted(world, last, i));
      if (!a || !b || (!inside(*a) && !inside(*b))) continue;
      longest = std::max(longest, quick::hypot(b->u - a->u, b->v - a->v));
    }
  }
  return longest;
}

}  // namespace rubble
