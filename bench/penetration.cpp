#include "bench/penetration.h"

#include <ccd/ccd.h>

#include <algorithm>

#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr double kParallel = 1e-9;      // a shorter cross product of unit edges has no direction
constexpr double kCcdTolerance = 1e-7;  // unit: m
constexpr unsigned long kCcdIterations = 1000;

struct Interval {
  double low = 1e300, high = -1e300;
};

Interval project(const std::vector<Vec3>& corners, const Vec3& direction) {
  Interval range;
  for (const Vec3& c : corners) {
    const double d = dot(c, direction);
    range.low = std::min(range.low, d);
    range.high = std::max(range.high, d);
  }
  return range;
}

// Keeps the shorter of the two ways along a direction, if it is shorter than the best so far.
// Returns false when the hulls are farther apart along it than `gap`.
bool try_direction(const PlacedHull& a, const PlacedHull& b, const Vec3& direction, double gap,
                   Penetration& best) {
  const Interval ia = project(a.hull.corners, direction);
  const Interval ib = project(b.hull.corners, direction);
  if (ia.high - ib.low < best.depth) best = {ia.high - ib.low, direction};
  if (ib.high - ia.low < best.depth) best = {ib.high - ia.low, -direction};
  return best.depth >= -gap;
}

// A hull as libccd sees it: corners about a common origin, enlarged by a sphere.
struct CcdHull {
  const PlacedHull* hull;
  Vec3 origin;
  double radius;
};

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* result) {
  const auto& o = *static_cast<const CcdHull*>(object);
  const Vec3 d{direction->v[0], direction->v[1], direction->v[2]};
  const auto farthest =
      std::max_element(o.hull->hull.corners.begin(), o.hull->hull.corners.end(),
                       [&d](const Vec3& p, const Vec3& q) { return dot(p, d) < dot(q, d); });
  const Vec3 p = *farthest - o.origin + normalized(d) * o.radius;
  ccdVec3Set(result, p.x, p.y, p.z);
}

ccd_t make_settings() {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = support;
  ccd.support2 = support;
  ccd.max_iterations = kCcdIterations;
  ccd.epa_tolerance = kCcdTolerance;
  ccd.dist_tolerance = kCcdTolerance;
  return ccd;
}

}  // namespace

Penetration calc_penetration(const PlacedHull& a, const PlacedHull& b, double gap) {
  Penetration best;
  for (const PlacedHull* hull : {&a, &b}) {
    for (const Vec3& n : hull->hull.face_normals) {
      if (!try_direction(a, b, n, gap, best)) return best;
    }
  }
  for (const Vec3& ea : a.hull.edge_directions) {
    for (const Vec3& eb : b.hull.edge_directions) {
      const Vec3 c = cross(ea, eb);
      const double length = norm(c);
      if (length > kParallel && !try_direction(a, b, c * (1 / length), gap, best)) return best;
    }
  }
  return best;
}

double calc_depth_ccd(const PlacedHull& a, const PlacedHull& b) {
  const CcdHull ca{&a, a.middle, 0}, cb{&b, a.middle, 0};
  const ccd_t ccd = make_settings();
  ccd_real_t depth = 0;
  ccd_vec3_t direction, position;
  const int result = ccdGJKPenetration(&ca, &cb, &ccd, &depth, &direction, &position);
  if (result == -2) throw RunError("libccd: no memory");
  return result == 0 ? depth : 0;
}

bool closer_than_ccd(const PlacedHull& a, const PlacedHull& b, double gap) {
  const CcdHull ca{&a, a.middle, 0}, cb{&b, a.middle, gap};
  const ccd_t ccd = make_settings();
  return ccdGJKIntersect(&ca, &cb, &ccd) == 1;
}

}  // namespace rubble
