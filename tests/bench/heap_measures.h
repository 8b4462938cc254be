// Figures of a heap as an engineer would take them, on the true hulls.
#pragma once

#include <vector>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// The slope of a heap about the Z axis, taken for a cone: half of a cone's volume lies within half
// its radius, and half of it below 1 - 2^(-1/3) of its height. Medians over the pieces hardly feel
// those that rolled away, and vary much less from heap to heap than a line fitted to the surface.
// unit: rad
double calc_slope(const PileState& state);

// The share of a box that is filled, by sampling points. Immovable pieces are left out; the box
// should keep clear of them.
double calc_filled_share(const std::vector<PieceType>& types, const PileState& state,
                         const Aabb& box, int samples);

}  // namespace rubble
