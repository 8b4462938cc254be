// The cells of a grid that a ray passes, one after the other (Amanatides and Woo 1987, "A fast voxel traversal algorithm
// for ray tracing").
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/geometry/voxel_grid.h"

namespace rubble {

// The part of a ray within a grid, in lengths of its direction from its origin; empty when last < first.
struct RaySpan {
  double first = 0, last = 0;
};

inline RaySpan clip_to_grid(const VoxelGrid& grid, const Vec3& from, const Vec3& direction, double length) {
  RaySpan span{0, length};
  for (int k = 0; k < 3; ++k) {
    const double low = grid.corner[k] - from[k], high = low + grid.size[std::size_t(k)] * grid.voxel;
    if (direction[k] == 0) {
      if (low > 0 || high <= 0) return {0, -1};
      continue;
    }
    const double a = low / direction[k], b = high / direction[k];
    span.first = std::max(span.first, std::min(a, b));
    span.last = std::min(span.last, std::max(a, b));
  }
  return span;
}

// Calls visit(index of a cell) until it returns false or the ray has gone `length` times its direction. All are finite.
template <typename Visit>
void walk_cells(const VoxelGrid& grid, const Vec3& from, const Vec3& direction, double length, Visit&& visit) {
  const RaySpan span = clip_to_grid(grid, from, direction, length);
  if (span.last < span.first) return;
  constexpr double kNoBorder = std::numeric_limits<double>::infinity();
  Cell cell = grid.find_cell(from + direction * span.first);
  double next[3], between[3];  // to the next border along each axis, and from one to the next
  int step[3];
  for (std::size_t k = 0; k < 3; ++k) {
    cell[k] = std::clamp(cell[k], 0, grid.size[k] - 1);
    const double d = direction[int(k)];
    step[k] = d > 0 ? 1 : -1;
    const double border = grid.corner[int(k)] + (cell[k] + (d > 0 ? 1 : 0)) * grid.voxel;
    next[k] = d != 0 ? (border - from[int(k)]) / d : kNoBorder;
    between[k] = d != 0 ? grid.voxel / std::fabs(d) : kNoBorder;
  }
  while (grid.contains(cell)) {
    if (!visit(grid.index(cell))) return;
    const std::size_t k = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (next[k] > span.last) return;
    cell[k] += step[k];
    next[k] += between[k];
  }
}

}  // namespace rubble
