#include "kernel/fines/resting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kSunk = 0.03;         // into what it lies on, as a share of the height of its middle
constexpr double kLook = 0.02;         // above a body, for what is below its corners; unit: m

}  // namespace

Quat turn_between(const Vec3& from, const Vec3& to) {
  const double along = dot(from, to);
  if (along < -0.999999) {  // any axis across
    const Vec3 axis = normalized(cross(std::fabs(from.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0), from));
    return {0, axis.x, axis.y, axis.z};
  }
  const Vec3 axis = cross(from, to);
  return normalized(Quat(1 + along, axis.x, axis.y, axis.z));
}

Tangents make_tangents(const Vec3& normal, double yaw) {
  const Quat up = turn_between({0, 0, 1}, normal);
  const auto [s, c] = portable::sincos(yaw);
  return {up.rotate({c, s, 0}), up.rotate({-s, c, 0})};
}

std::optional<RayHit> find_below(const PileQueries& queries, const Vec3& from, double farthest) {
  const std::optional<RayHit> hit = queries.cast_ray(from, {0, 0, -1}, farthest);
  return hit && hit->normal.z > kSteepestRest ? hit : std::nullopt;
}

Pose rest_on(const Support& support, const FineShape& shape, const Vec3f& half, bool flat, double yaw,
             double& middle_height) {
  const FineBase base = flat ? FineBase{0, {0, 0, -1}, double(half.z)} : find_base(shape, half);
  middle_height = (1 - kSunk) * base.distance;
  const auto [s, c] = portable::sincos(0.5 * yaw);
  const Quat about_normal{c, support.normal.x * s, support.normal.y * s, support.normal.z * s};
  const Quat down = turn_between(base.normal, {0, 0, -1}), tilt = turn_between({0, 0, 1}, support.normal);
  return {normalized(about_normal * tilt * down), support.point + support.normal * middle_height};
}

std::optional<Support> find_support(const PileQueries& queries, const RayHit& below, double reach, double yaw,
                                    double gap) {
  const Tangents t = make_tangents({0, 0, 1}, yaw);
  std::array<Vec3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 aside = (i < 2 ? t.x : t.y) * (i % 2 ? -reach : reach);
    const auto hit = find_below(queries, below.point + aside + Vec3(0, 0, kLook + reach), kLook + 3 * reach);
    if (!hit) return std::nullopt;
    corners[i] = hit->point;
  }
  Support support;
  support.host = below.piece;
  support.normal = normalized(cross(corners[0] - corners[1], corners[2] - corners[3]));
  if (support.normal.z < kSteepestRest) return std::nullopt;
  double highest = dot(support.normal, below.point), lowest = highest;
  for (const Vec3& corner : corners) {
    const double height = dot(support.normal, corner);
    highest = std::max(highest, height), lowest = std::min(lowest, height);
  }
  if (highest - lowest > gap) return std::nullopt;
  support.point = below.point + support.normal * (highest - dot(support.normal, below.point));
  return support;
}

}  // namespace rubble
