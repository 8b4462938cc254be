// Convex hulls of small point sets, with the same topology on every machine.
//
// The points are rounded to an integer grid of 2^19 steps along their longest extent, and the hull
// is that of kernel/geometry/lattice_hull.h, by exact integer predicates. So rounding cannot go wrong at
// coplanar and collinear points. Faces within about one degree of a larger neighbour are then merged
// into one polygon, as long as all corners stay in its plane within 1e-5 of the longest extent or
// 0.03 mm, whichever is more. So contacts on a nearly flat side behave as on a flat side, and a drum
// keeps all its sides.
#pragma once

#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct Hull {
  std::vector<Vec3> points;             // the corners only, as given (not rounded)
  std::vector<std::vector<int>> faces;  // corner indices, counter-clockwise seen from outside
};

// Throws std::invalid_argument when the points do not span a volume.
Hull calc_hull(const std::vector<Vec3>& points);

// The plane of a face: points of the hull have dot(normal, p) <= offset, up to rounding.
struct HullPlane {
  Vec3 normal;        // unit length, outwards
  double offset = 0;  // unit: m
};
// One per face. A face that is too narrow to have a direction gets no normal and an offset that bounds nothing; its
// neighbours bound the hull there.
std::vector<HullPlane> calc_planes(const Hull& hull);

// The difference between a solid and a hull, or a union of hulls.
struct Misfit {
  double outside = 0;  // volume of the hulls outside the solid; unit: m3
  double inside = 0;   // volume of the solid outside the hulls; only of a union; unit: m3
  double gap = 0;      // the largest distance of a point of the hulls from the solid; unit: m
};

double calc_volume(const Hull& hull);  // unit: m3
// Volume of the hull of the points; 0 if they span none. unit: m3
double calc_hull_volume(const std::vector<Vec3>& points);

}  // namespace rubble
