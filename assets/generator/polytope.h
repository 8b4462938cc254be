// Convex polytopes with few faces, by exhaustive search: at most some dozens of planes and points,
// so the simple way is quick enough.
#pragma once

#include <vector>

#include "assets/generator/solid.h"
#include "kernel/base/math.h"

namespace rubble::generator {

// Corners of the intersection of the flat faces of a cell (round ones are passed over), equal ones
// merged. Throws RunError when there are fewer than 4.
std::vector<Vec3> corners_of(const Cell& cell);

struct Polygon {
  std::vector<int> corners;  // indices, counter-clockwise seen from outside
  Vec3 normal;               // unit length, outward
};

// The faces of the convex hull of some points, which count as rounded to 10 um and must not be more
// than 10 m apart. Exact: neighbouring faces share their edges, and no point is above a face.
// Points that are no corner appear in no polygon.
std::vector<Polygon> hull_faces(const std::vector<Vec3>& points);

// Volume of the hull. unit: m3
double hull_volume(const std::vector<Vec3>& points);

}  // namespace rubble::generator
