// Paths of a ball through the free space of a pile.
#pragma once

#include <vector>

#include "kernel/voids/void_space.h"

namespace rubble {

struct FoundPath {
  bool found = false;  // false: there is no path, and `points` and `length` have no meaning
  // Corners of straight segments from start to goal; every segment keeps the clearance; unit: m.
  std::vector<Vec3> points;
  double length = 0;  // unit: m
  // The narrowest place of the path, or of the widest possible path if the ball does not pass.
  double narrowest_radius = 0;  // unit: m; 0: no path for any ball
  Vec3 narrowest;               // place with the least clearance; unit: m
};

// The shortest path, outside and through voids, on which the centre of the ball keeps the distance `radius` from all
// surfaces (A* over the 26 neighbours of cells, then shortened). Start and goal are replaced by the centres of their
// cells, and must be inside the grid (std::invalid_argument otherwise).
FoundPath find_path(const VoidSpace& space, const Vec3& start, const Vec3& goal, double radius);

// Length of the shortest path of a ball's centre from a point to every cell, in steps between the 26 neighbours with
// clearance >= radius. Infinite without a path, and everywhere if the cell of the point has less clearance. from:
// inside the grid (std::invalid_argument otherwise). unit: m
std::vector<float> calc_ways_through(const VoidSpace& space, const Vec3& from, double radius);

// Centre of the nearest free cell with clearance >= radius within `reach` of a point. If there is none, `found` is
// false and the position is the point itself.
struct NearestPlace {
  bool found = false;
  Vec3 position;
};
NearestPlace find_nearest_place(const VoidSpace& space, const Vec3& point, double radius,
                                double reach);

}  // namespace rubble
