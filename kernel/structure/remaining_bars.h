// The bars of a bond after its concrete has failed, as ties between its pieces.
#pragma once

#include <vector>

#include "kernel/model/pile_state.h"
#include "kernel/structure/structure.h"

namespace rubble {

// One tie, or two side by side where the section is wide, so that what hangs on it turns like a hinge.
// Pieces have their numbers in the structure; b is -1 for the foundation. continuity: share of the bars
// that hold; range: 0 to 1. None where the section has no bars.
std::vector<TieState> find_remaining_bars(const Structure& structure, const Bond& bond, double continuity);

}  // namespace rubble
