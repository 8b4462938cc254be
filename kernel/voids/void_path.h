// Ways through the free space of a pile for a ball.
#pragma once

#include <vector>

#include "kernel/voids/void_space.h"

namespace rubble {

struct FoundPath {
  bool found = false;  // false: there is no way, and the rest means nothing
  // From start to goal, corners of straight legs along which the clearance is kept; unit: m.
  std::vector<Vec3> points;
  double length = 0;  // unit: m
  // Of the way that was found or, where the ball does not pass, of the widest way that there is:
  // where it is narrowest, and how wide.
  double narrowest_radius = 0;  // unit: m; 0: no way for anything
  Vec3 narrowest;               // place on the way with the least clearance; unit: m
};

// The shortest way, outside and through voids, on which the ball's centre keeps `radius` from all
// surfaces (A* over the 26 neighbours of cells, then pulled tight). Start and goal are those of the
// cells they lie in, and must be inside the grid (std::invalid_argument otherwise).
FoundPath find_path(const VoidSpace& space, const Vec3& start, const Vec3& goal, double radius);

// The length of the shortest way of a ball's centre from a point to every cell, by steps to the 26 neighbours
// between cells with clearance >= radius; infinite where none leads, and everywhere when the cell of the point
// has less. from: inside the grid (std::invalid_argument otherwise). unit: m
std::vector<float> calc_ways_through(const VoidSpace& space, const Vec3& from, double radius);

// The free cell with clearance >= radius that is nearest to a point, not farther than `reach`; its
// centre, or the point itself when there is none (`found` tells).
struct NearestPlace {
  bool found = false;
  Vec3 position;
};
NearestPlace find_nearest_place(const VoidSpace& space, const Vec3& point, double radius,
                                double reach);

}  // namespace rubble
