// Convex hulls of small point sets, with the same topology on every machine.
//
// The points are rounded to an integer grid of 2^19 steps along their longest extent, and the hull
// is gift-wrapped (Chand and Kapur 1970) with exact integer predicates, so coplanar and collinear
// points are no special cases of rounding. Faces within about one degree of a larger neighbour are
// then merged into one polygon while all corners stay in its plane, to 1e-5 of the longest extent or
// 0.03 mm, whichever is more: contacts on a nearly flat side behave as on a flat one, and a drum
// keeps its sides, however many.
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

// The plane of a face: points of the hull have dot(normal, p) <= offset, but for rounding.
struct HullPlane {
  Vec3 normal;        // unit length, outwards
  double offset = 0;  // unit: m
};
// One per face. Of a face that is too narrow to have a direction, no normal, and an offset that bounds nothing: its
// neighbours do.
std::vector<HullPlane> calc_planes(const Hull& hull);

// How much of a hull, or of a union of hulls, and of a solid is not in the other.
struct Misfit {
  double outside = 0;  // volume of the hulls outside the solid; unit: m3
  double inside = 0;   // volume of the solid outside the hulls; only of a union; unit: m3
  double gap = 0;      // the largest distance of a point of the hulls from the solid; unit: m
};

double calc_volume(const Hull& hull);  // unit: m3
// Of the hull of the points; 0 where they span none.
double calc_hull_volume(const std::vector<Vec3>& points);

}  // namespace rubble
