// How deep two convex hulls overlap, answered in two ways that share nothing.
//
// The depth is the shortest translation that parts the hulls. For polyhedra its direction is a face
// normal of one of them or the cross product of two edges, because these are the faces of their
// Minkowski difference; so trying all of them gives the exact answer, up to rounding. libccd
// answers the same question by GJK and an expanding polytope, with no knowledge of faces.
#pragma once

#include "bench/true_hull.h"

namespace rubble {

struct Penetration {
  // Negative: the hulls are apart, and at least this far. unit: m
  double depth = 1e300;
  Vec3 direction;  // moving b by depth along it parts the hulls; unit length
};
// gap: hulls that are apart by less than this get their exact figures, too: the direction along which
// they are farthest apart; at most their distance, which it equals unless corner is next to corner or edge. unit: m; >= 0
Penetration calc_penetration(const PlacedHull& a, const PlacedHull& b, double gap = 0);

// libccd's depth, 0 when it finds the hulls apart. unit: m
double calc_depth_ccd(const PlacedHull& a, const PlacedHull& b);

// Whether the hulls overlap or are closer than `gap` (libccd; b is enlarged by a sphere). unit: m
bool closer_than_ccd(const PlacedHull& a, const PlacedHull& b, double gap);

}  // namespace rubble
