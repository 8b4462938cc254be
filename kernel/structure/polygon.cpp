#include "kernel/structure/polygon.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

// A normal counts as vertical where its upward part is larger: within about 8 degrees.
constexpr double kVertical = 0.99;

}  // namespace

Polygon clip(const Polygon& polygon, const HalfSpace& half_space) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = dot(half_space.normal, a) - half_space.offset;
    const double db = dot(half_space.normal, b) - half_space.offset;
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  if (kept.size() < 3) kept.clear();
  return kept;
}

PlaneAxes make_axes(const Vec3& normal) {
  const Vec3 up = std::abs(normal.z) < kVertical ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  const Vec3 t = normalized(up - normal * dot(up, normal));
  return {cross(t, normal), t};
}

Polygon cut_plane(const HalfSpace& plane, const std::vector<HalfSpace>& others, double extent) {
  const PlaneAxes axes = make_axes(plane.normal);
  const Vec3 s = axes.s * (2 * extent), t = axes.t * (2 * extent);
  const Vec3 centre = plane.normal * plane.offset;
  Polygon polygon{centre - s - t, centre + s - t, centre + s + t, centre - s + t};
  for (const HalfSpace& other : others) polygon = clip(polygon, other);
  return polygon;
}

AreaProperties calc_area_properties(const Polygon& polygon, const PlaneAxes& axes) {
  AreaProperties result;
  if (polygon.size() < 3) return result;
  const Vec3 origin = polygon[0];
  const auto at_s = [&](const Vec3& p) { return dot(p - origin, axes.s); };
  const auto at_t = [&](const Vec3& p) { return dot(p - origin, axes.t); };
  double area = 0, first_s = 0, first_t = 0, second_s = 0, second_t = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double s1 = at_s(polygon[i]), t1 = at_t(polygon[i]);
    const double s2 = at_s(polygon[i + 1]), t2 = at_t(polygon[i + 1]);
    const double doubled = s1 * t2 - s2 * t1;
    area += doubled / 2;
    first_s += doubled * (s1 + s2) / 6;
    first_t += doubled * (t1 + t2) / 6;
    second_s += doubled * (t1 * t1 + t1 * t2 + t2 * t2) / 12;
    second_t += doubled * (s1 * s1 + s1 * s2 + s2 * s2) / 12;
  }
  if (!(area > 0)) return result;
  const double cs = first_s / area, ct = first_t / area;
  result.area = area;
  result.centroid = origin + axes.s * cs + axes.t * ct;
  result.inertia_s = second_s - area * ct * ct;
  result.inertia_t = second_t - area * cs * cs;
  for (const Vec3& p : polygon) {
    result.half_s = std::max(result.half_s, std::abs(at_s(p) - cs));
    result.half_t = std::max(result.half_t, std::abs(at_t(p) - ct));
  }
  return result;
}

}  // namespace rubble
