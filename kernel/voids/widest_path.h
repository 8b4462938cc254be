// How wide the widest way from outside is, for every cell of a void at once.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/voids/void_space.h"

namespace rubble {

inline constexpr std::uint32_t kNoCell = 0xffffffffu;

struct WidestPaths {
  // The radius of the largest ball that can come from outside to here, and 0 where none can: the
  // largest over all paths of the smallest clearance along the path; unit: m. Exact to 1/16 voxel.
  std::vector<float> radius;
  // The cell where that path is narrowest; kNoCell where there is none.
  std::vector<std::uint32_t> narrowest;
};

// Of void cells; others have radius 0. A priority flood from the border of the void (Barnes, Lehman
// and Mulla 2014, "Priority-flood"; here for the largest minimum instead of the smallest maximum).
WidestPaths find_widest_paths(const VoidSpace& space);

}  // namespace rubble
