// Convex hulls with fewer corners.
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct SimpleHull {
  std::vector<Vec3> points;  // the corners, of the given points
  double error = 0;          // the largest distance of a given point from the hull of the corners; unit: m
};

// Selects points whose hull is close to the hull of all points. The point that stands out farthest becomes a corner,
// again and again, until none stands out by more than `tolerance` or there are `most` corners (at least 8). The extreme
// points along the axes are always included, so the hull keeps its length, width and height. Throws
// std::invalid_argument for points that do not span a volume.
SimpleHull simplify_hull(const std::vector<Vec3>& points, std::size_t most, double tolerance);

// Moves the corners of a simplified hull outwards, most where most was lost, until it has the volume of the hull of
// `points`. The hull stays within the bounding box of the points. So round shapes keep their volume and their length.
std::vector<Vec3> restore_volume(const SimpleHull& simple, const std::vector<Vec3>& points);

}  // namespace rubble
