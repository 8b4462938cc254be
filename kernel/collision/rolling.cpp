#include "kernel/collision/rolling.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

// A piece that turns by less than this in a step is pushed about where it is. unit: rad
constexpr float kRollingTurn = 0.1F;
// The reach in all directions across the axis differs by no more than this share. unit: 1
constexpr float kRoundness = 0.005F;
// An axis nearer to the normal than this spins on the spot. The sine of 17 degrees; unit: 1
constexpr float kLeastSine = 0.3F;
// Directions that are looked at, a golden angle apart: no number of facets meets them all alike.
// unit: 1
constexpr int kDirections = 24;
constexpr float kGoldenCosine = -0.73736888F;  // of the golden angle, 137.5 degrees; unit: 1
constexpr float kGoldenSine = 0.67549029F;     // of the golden angle; unit: 1
// Points of a wheel narrower than this are one. unit: m
constexpr float kNarrow = 0.005F;

// How far the corners reach, the mean of those on either side of the centre of mass along the axis:
// a body that wobbles about its spin reaches as much farther at one end as less at the other.
float calc_reach(const PointSet& corners, const Vec3f& axis, const Vec3f& direction) {
  float ahead = -1e30F, behind = -1e30F;
  for (int i = 0; i < corners.count; ++i) {
    const Vec3f& p = corners.points[i];
    float& side = dot(p, axis) > 0 ? ahead : behind;
    side = std::max(side, dot(p, direction));
  }
  return 0.5F * (ahead + behind);
}

// across: unit length, at right angles to the axis.
bool is_round(const PointSet& corners, const Vec3f& axis, const Vec3f& across) {
  const Vec3f other = cross(axis, across);
  float least = 1e30F, most = -1e30F;
  float cosine = 1, sine = 0;
  for (int i = 0; i < kDirections; ++i) {
    const float r = calc_reach(corners, axis, across * cosine + other * sine);
    least = std::min(least, r), most = std::max(most, r);
    if (!(most - least <= kRoundness * most)) return false;
    const float next = cosine * kGoldenCosine - sine * kGoldenSine;
    sine = cosine * kGoldenSine + sine * kGoldenCosine;
    cosine = next;
  }
  return true;
}

// The lowest point of either half along the axis; returns how many there are.
int keep_ends(const Manifold& m, const Vec3f& axis, ManifoldPoint (&kept)[2]) {
  float first = 1e30F, last = -1e30F;
  for (int i = 0; i < m.count; ++i) {
    const float place = dot(m.points[i].position, axis);
    first = std::min(first, place), last = std::max(last, place);
  }
  const float middle = last - first > kNarrow ? 0.5F * (first + last) : 1e30F;
  const ManifoldPoint* lowest[2] = {};
  for (int i = 0; i < m.count; ++i) {
    const ManifoldPoint*& best = lowest[dot(m.points[i].position, axis) > middle ? 1 : 0];
    if (best == nullptr || m.points[i].separation < best->separation) best = &m.points[i];
  }
  int count = 0;
  for (const ManifoldPoint* point : lowest) {
    if (point != nullptr) kept[count++] = *point;
  }
  return count;
}

}  // namespace

bool rolls(const PosedBody& body, const Vec3f& normal, float step) {
  const float spin = norm(body.angular);
  if (!(spin * step > kRollingTurn)) return false;
  const Vec3f axis = body.angular * (1 / spin);
  const Vec3f across = normal - axis * dot(axis, normal);
  const float sine = norm(across);
  return sine > kLeastSine && is_round(body.part.corners, axis, across * (1 / sine));
}

void carry_below_axis(Manifold& m, const Vec3f& normal, const Vec3f& angular, const Vec3f& centre) {
  const Vec3f onwards = normalized(cross(angular, normal));
  ManifoldPoint ends[2];
  m.count = keep_ends(m, cross(normal, onwards), ends);
  for (int i = 0; i < m.count; ++i) {
    m.points[i] = ends[i];
    m.points[i].position -= onwards * dot(ends[i].position - centre, onwards);
  }
}

}  // namespace rubble
