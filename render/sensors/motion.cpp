#include "render/sensors/motion.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

constexpr double kInfinity = 1e6;  // unit: m; where the sky is
constexpr int kStep = 4;

}  // namespace

double longest_motion(const ViewRays& view, const std::vector<float>& distances,
                      const Pose& world_from_camera_before, const Pose& world_from_camera_after) {
  const Intrinsics& k = view.intrinsics;
  const Lens lens(k);
  const Pose before = (world_from_camera_before * camera_from_optical).inverse();
  const Pose after = (world_from_camera_after * camera_from_optical).inverse();
  const auto inside = [&](const PixelPoint& p) {
    return p.u > -1 && p.v > -1 && p.u < k.width && p.v < k.height;
  };
  double longest = 0;
  for (int v = kStep / 2; v < k.height; v += kStep) {
    const Pose pose = view.pose(v);
    for (int u = kStep / 2; u < k.width; u += kStep) {
      const Vec3 d = view.direction(u, v);
      if (d == Vec3()) continue;
      const double distance = double(distances[std::size_t(v) * std::size_t(k.width) +
                                               std::size_t(u)]);
      const Vec3 world = pose * (d * (std::isnan(distance) ? kInfinity : distance));
      const auto a = lens.project(before * world), b = lens.project(after * world);
      if (!a || !b || (!inside(*a) && !inside(*b))) continue;
      longest = std::max(longest, std::hypot(b->u - a->u, b->v - a->v));
    }
  }
  return longest;
}

}  // namespace rubble
