// Lengths of the shortest ways over some cells of a grid. Internal to kernel/voids.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "kernel/geometry/voxel_grid.h"
#include "kernel/voids/cell_slots.h"

namespace rubble {

// Calls visit(index, length of the step in cells) for the up to 26 cells around one.
template <typename Visit>
void for_each_around(const VoxelGrid& grid, std::size_t index, Visit&& visit) {
  static const double kLength[4] = {0, 1, std::sqrt(2.0), std::sqrt(3.0)};
  const Cell c = grid.cell(index);
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{c[0] + dx, c[1] + dy, c[2] + dz};
        const int steps = std::abs(dx) + std::abs(dy) + std::abs(dz);
        if (steps > 0 && grid.contains(n)) visit(grid.index(n), kLength[steps]);
      }
}

// Dijkstra from all cells of `starts` at once over `count` places. slot_of(cell): the number of the
// place there, or kNoSlot. Of each place; unit: cells; infinite where there is no way.
template <typename SlotOf>
std::vector<double> calc_ways_from(const VoxelGrid& grid, const std::vector<std::uint32_t>& starts,
                                   std::size_t count, const SlotOf& slot_of) {
  std::vector<double> length(count, std::numeric_limits<double>::infinity());
  using Item = std::pair<double, std::uint32_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<Item>> front;
  for (const std::uint32_t i : starts) {
    length[slot_of(i)] = 0;
    front.push({0, i});
  }
  while (!front.empty()) {
    const auto [done, i] = front.top();
    front.pop();
    if (done > length[slot_of(i)]) continue;
    for_each_around(grid, i, [&, far = done](std::size_t k, double step) {
      const std::uint32_t slot = slot_of(k);
      if (slot == kNoSlot || far + step >= length[slot]) return;
      length[slot] = far + step;
      front.push({length[slot], std::uint32_t(k)});
    });
  }
  return length;
}

}  // namespace rubble
