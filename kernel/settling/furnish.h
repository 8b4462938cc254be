// Places furniture in a building before the collapse.
#pragma once

#include <vector>

#include "kernel/model/pile.h"

namespace rubble {

// A place on the floors of the spec's building for everything in its `furniture`, drawn by its seed: upright,
// clear of columns, walls and each other, more often along a side of a bay than in its middle. What finds no
// room in a bay is left out there. bounds: by type, then by assembly; unit: m. Throws InputError for what is
// too high for a storey or too wide for a bay.
std::vector<Placement> furnish(const PileSpec& spec, const ByKind<Aabb>& bounds);

// Of its collision parts, in the frame of the piece; unit: m.
Aabb calc_bounds(const PieceType& type);

}  // namespace rubble
