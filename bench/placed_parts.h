// The convex parts of a pile as the judges see them: true hulls, placed in the world.
#pragma once

#include <functional>
#include <vector>

#include "bench/true_hull.h"
#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct PlacedPart {
  int piece = 0;
  bool fixed = false;
  PlacedHull hull;
};

// Of all pieces but the lost ones; surfaces have no parts.
std::vector<PlacedPart> place_parts(const std::vector<PieceType>& types, const PileState& state);

// Calls visit(part, part) once for each two parts of different pieces, not both fixed, whose boxes
// come closer than `gap`. unit: m
using VisitParts = std::function<void(const PlacedPart&, const PlacedPart&)>;
void find_near_parts(const std::vector<PlacedPart>& parts, double gap, const VisitParts& visit);

}  // namespace rubble
