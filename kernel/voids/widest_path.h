// Width of the widest path from outside to each cell of a void.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/voids/cell_slots.h"
#include "kernel/voids/void_space.h"

namespace rubble {

inline constexpr std::uint32_t kNoCell = 0xffffffffu;

struct WidestPaths {
  CellSlots cells;  // of the void; numbers the two lists below
  // Radius of the largest ball that can reach the cell from outside, or 0: the maximum over all
  // paths of the smallest clearance along the path; unit: m. Exact to 1/16 voxel.
  std::vector<float> radius;
  // The narrowest cell of that path, as an index of the grid; kNoCell without a path.
  std::vector<std::uint32_t> narrowest;
};

// A priority flood from the border of the void (Barnes, Lehman
// and Mulla 2014, "Priority-flood"; here for the largest minimum instead of the smallest maximum).
WidestPaths find_widest_paths(const VoidSpace& space);

}  // namespace rubble
