// A grid of cubic cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernel/base/math.h"

namespace rubble {

using Cell = std::array<int, 3>;  // x, y, z

// Cells are numbered with x fastest and z slowest. Values belong to the centres of cells.
struct VoxelGrid {
  Vec3 corner;         // the lowest corner of cell (0, 0, 0), in the world; unit: m
  double voxel = 0.1;  // edge length; unit: m
  Cell size{0, 0, 0};

  std::size_t count() const {
    return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
  }
  std::size_t index(const Cell& c) const {
    return std::size_t(c[0]) +
           std::size_t(size[0]) * (std::size_t(c[1]) + std::size_t(size[1]) * std::size_t(c[2]));
  }
  Cell cell(std::size_t index) const {
    const std::size_t x = std::size_t(size[0]), y = std::size_t(size[1]);
    return {int(index % x), int(index / x % y), int(index / (x * y))};
  }
  bool contains(const Cell& c) const {
    return c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < size[0] && c[1] < size[1] &&
           c[2] < size[2];
  }
  Vec3 centre(const Cell& c) const {
    return corner + Vec3{c[0] + 0.5, c[1] + 0.5, c[2] + 0.5} * voxel;
  }
  Vec3 centre(std::size_t index) const { return centre(cell(index)); }
  // The cell of a point, also outside of the grid.
  Cell find_cell(const Vec3& p) const {
    const Vec3 q = (p - corner) * (1 / voxel);
    return {int(std::floor(q.x)), int(std::floor(q.y)), int(std::floor(q.z))};
  }
};

// Calls visit(index) for each neighbour that shares a face with a cell, at most six.
template <typename Visit>
void for_each_neighbour(const VoxelGrid& grid, std::size_t index, Visit&& visit) {
  const Cell c = grid.cell(index);
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (c[std::size_t(axis)] > 0) visit(index - stride);
    if (c[std::size_t(axis)] + 1 < grid.size[std::size_t(axis)]) visit(index + stride);
    stride *= std::size_t(grid.size[std::size_t(axis)]);
  }
}

}  // namespace rubble
