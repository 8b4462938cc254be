// Placed pieces that reach into each other before anything moves.
#pragma once

#include <vector>

#include "kernel/model/pile.h"

namespace rubble {

struct PlacedOverlap {
  int a = 0, b = 0;  // indices of the placements, a < b
  double depth = 0;  // the distance that takes their convex parts out of each other, at least; unit: m
};

// Deeper than `least` (unit: m), the deepest first. Placements of assemblies and of surfaces are left out, and pairs
// without any of the first `own`.
std::vector<PlacedOverlap> find_placed_overlaps(const std::vector<PieceType>& types, const std::vector<Placement>& placed,
                                                std::size_t own, double least);

}  // namespace rubble
