// Every place where the pieces of a pile touch each other, the ground or terrain, found by the
// judge's own geometry (contact_patch.h) on the true convex parts.
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "bench/placed_parts.h"

namespace rubble {

// Surfaces nearer to each other than this touch. The kernel keeps resting surfaces 1 mm apart. A
// smaller one misses contacts, and a resting pile looks unsupported; a larger lets a tilted edge
// carry like the face beside it. unit: m
inline constexpr double kContactTolerance = 0.002;

inline constexpr int kGroundPiece = -1;

struct TouchPoint {
  int a = 0, b = 0;  // pieces; a may be kGroundPiece
  Vec3 point;        // unit: m
  Vec3 normal;       // from a to b, unit length
  double gap = 0;    // between the parts that touch, negative in overlap; to surfaces 0; unit: m
};

// How deep pieces are in surfaces such as terrain: the deepest corner of either in the other.
struct SurfaceDepth {
  double depth = 0;  // unit: m
  int piece = -1;
};

using PiecePairs = std::set<std::pair<int, int>>;  // the smaller number first

// The ground is z = 0. Pairs in `apart` do not touch, whatever their geometry (built into each other
// by a joint).
std::vector<TouchPoint> find_touch_points(const std::vector<PieceType>& types,
                                          const PileState& state, const PiecePairs& apart,
                                          double tolerance);

SurfaceDepth find_surface_depth(const std::vector<PieceType>& types, const PileState& state);

}  // namespace rubble
