// Width of the widest path from outside to each cell of a void.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/voids/cell_slots.h"
#include "kernel/voids/void_space.h"

namespace rubble {

inline constexpr std::uint32_t kNoCell = 0xffffffffu;

struct WidestPaths {
  std::shared_ptr<const CellSlots> cells;  // those of the void, and maybe others; numbers the two lists below
  // The narrowest cell of the widest path from outside to the cell, as an index of the grid; kNoCell without a path.
  std::vector<std::uint32_t> narrowest;
  // Whether the cell outside before the narrowest is narrower still.
  std::vector<bool> is_entry_narrower;

  // Radius of the largest ball that can reach a cell of the void from outside, or 0: the maximum over all paths of the
  // smallest clearance along the path; unit: m. space: of these paths.
  float radius(const VoidSpace& space, std::size_t cell) const;
};

// A priority flood from the border of the void (Barnes, Lehman
// and Mulla 2014, "Priority-flood"; here for the largest minimum instead of the smallest maximum).
WidestPaths find_widest_paths(const VoidSpace& space);

}  // namespace rubble
