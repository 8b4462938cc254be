#include "render/sensors/motion.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr double kInfinity = 1e6;  // unit: m; where the sky is
constexpr int kStep = 4;
constexpr int kLooks = 16;            // at the camera's way, to tell whether it is straight
constexpr double kStraightTurn = 0.2;  // of a straight part, at most; unit: rad
constexpr double kDetour = 1.05;      // a way this much longer than that from end to end is not straight
constexpr double kNoWay = 1e-3;       // unit: m
constexpr int kMostParts = 64;

Vec3 shifted(const Vec3& world, const MomentNearby& moment, std::size_t pixel) {
  return moment.shifts.empty() ? world : world + Vec3(moment.shifts[pixel]);
}

double turn_between(const Pose& a, const Pose& b) {
  const Quat turn = a.rotation.conjugate() * b.rotation;
  return 2 * quick::atan2(norm(Vec3(turn.x, turn.y, turn.z)), std::fabs(turn.w));
}

std::int64_t time_of(std::int64_t from, std::int64_t to, int part, int parts) {
  return part == parts ? to : from + (to - from) / parts * part;
}

}  // namespace

std::vector<std::int64_t> cut_way(const Flight& flight, std::int64_t from, std::int64_t to) {
  if (to - from < kLooks) return {from, to};
  double turn = 0, way = 0;
  const Pose first = flight.pose_at(from);
  Pose before = first;
  for (int i = 1; i <= kLooks; ++i) {
    const Pose now = flight.pose_at(time_of(from, to, i, kLooks));
    turn += turn_between(before, now), way += distance(before.translation, now.translation);
    before = now;
  }
  const bool detour = way > kDetour * distance(first.translation, before.translation) + kNoWay;
  if (turn <= kStraightTurn && !detour) return {from, to};
  const int parts = std::clamp(int(std::ceil(turn / kStraightTurn)), kLooks, kMostParts);
  std::vector<std::int64_t> out;
  for (int i = 0; i <= parts; ++i) out.push_back(time_of(from, to, i, parts));
  return out;
}

double longest_way(const ViewRays& view, const std::vector<float>& distances, const std::vector<MomentNearby>& moments) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < moments.size(); ++i) {
    double part = longest_motion(view, distances, moments[i], moments[i + 1]);
    if (moments.size() > 2)
      part = std::max(part, view.intrinsics.fx * turn_between(moments[i].world_from_camera, moments[i + 1].world_from_camera));
    sum += part;
  }
  return sum;
}

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
