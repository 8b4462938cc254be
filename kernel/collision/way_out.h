// Which way leads two pieces of several parts out of each other. Each pair of convex parts knows only its
// own shortest way: a bar in a grid, or a sheet sunk into the seam of two parts, is pushed to one side by
// one part and back by the next, for ever. Here all overlapping parts of two pieces agree on one direction.
#pragma once

#include <vector>

#include "kernel/collision/sat.h"

namespace rubble {

// Two parts that overlap, and the normal (from A to B, unit length) that their own search found.
struct OverlappingParts {
  PosedPart a, b;  // one of each piece
  Vec3f normal;    // from A to B, unit length
};

// How far two parts must be moved along a direction (unit length, from A to B) until they no longer
// overlap; `offset` is added to B's corners; negative: apart already; unit: m.
float calc_depth_along(const PosedPart& a, const PosedPart& b, const Vec3f& offset,
                       const Vec3f& direction);

// The direction, from A to B, along which the two pieces come apart soonest: the least of the greatest
// depths of the overlapping parts, among their faces and normals, such that no other parts of the two
// overlap after that; where there is none, the least alone. `before`: the direction of the step before
// (zero: none), which is kept while it is not much worse. `parts_a`, `parts_b`: all parts of the pieces.
Vec3f find_way_out(const std::vector<OverlappingParts>& overlapping,
                   const std::vector<PosedPart>& parts_a, const std::vector<PosedPart>& parts_b,
                   const Vec3f& offset, const Vec3f& before);

}  // namespace rubble
