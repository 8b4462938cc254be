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

// Given points whose hull comes near that of all: corners are added where points stand out farthest, until none
// stands out by more than `tolerance` or there are `most` corners (at least 8). The points that are farthest along the
// axes are among them, so the hull keeps its length, width and height. Throws std::invalid_argument for points
// that do not span a volume.
SimpleHull simplify_hull(const std::vector<Vec3>& points, std::size_t most, double tolerance);

// Moves the corners of a simplified hull outwards where it lost most, until it has the volume of the hull of `points`,
// within the box around them: round things keep their volume and their length.
std::vector<Vec3> restore_volume(const SimpleHull& simple, const std::vector<Vec3>& points);

}  // namespace rubble
