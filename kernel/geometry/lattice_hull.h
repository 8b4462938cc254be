// The convex hull of points of an integer lattice, without rounding: quickhull (Barber, Dobkin and Huhdanpaa 1996) with
// exact predicates. Triangles in one plane are one face, so coplanar and collinear points are no special cases.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// |x|, |y|, |z| < 2^19, so that every product stays under 2^60.
struct GridPoint {
  std::int64_t x, y, z;
  bool operator<(const GridPoint& b) const {
    return x != b.x ? x < b.x : (y != b.y ? y < b.y : z < b.z);
  }
  bool operator==(const GridPoint& b) const { return x == b.x && y == b.y && z == b.z; }
};

using Polygon = std::vector<int>;

constexpr double kLatticeSteps = 524288.0;  // 2^19

// Points in steps of 2^-19 of their longest extent.
struct LatticePoints {
  std::vector<GridPoint> grid;  // ascending, no two equal
  std::vector<int> source;      // of each, the point that it is: the first of equal ones
  double longest = 0;           // extent of the points along an axis; unit: m
};
// Throws std::invalid_argument for fewer than four points, or without an extent.
LatticePoints round_to_lattice(const std::vector<Vec3>& points);

// Which of some polygons has a directed edge. No two have the same.
class FaceOfEdge {
 public:
  explicit FaceOfEdge(const std::vector<Polygon>& faces);
  static std::uint64_t key(int a, int b) { return std::uint64_t(std::uint32_t(a)) << 32 | std::uint32_t(b); }
  int find(std::uint64_t edge) const;

 private:
  std::vector<std::pair<std::uint64_t, int>> edges_;  // ascending
};

// points: ascending, no two equal. The faces have strict corners only, counter-clockwise seen from outside, from their
// lowest point on. The first lies over the outline of the points in (x, y); each next one lies over the lowest edge that
// has one face. Throws std::invalid_argument when the points do not span a volume.
std::vector<Polygon> calc_lattice_hull(const std::vector<GridPoint>& points);

}  // namespace rubble
