// Fines as meshes: all of one kind that lie on one piece, or on the ground, within one cell.
#pragma once

#include "kernel/model/fines.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// Edge of a cell in the frame of the host; unit: m. A heap is drawn or left out as a whole, and has one
// number.
inline constexpr double kFineCell = 1.0;

// Makes what Fines::heaps() returns.
void heap_fines(Fines& fines);

// Of the frame that a heap's or a fine piece's host has.
Pose world_from_host(const PileState& pile, int host);

}  // namespace rubble
