// Walls with windows, doors and balconies. Internal to kernel/surroundings.
#pragma once

#include <string>
#include <vector>

#include "kernel/geometry/mesh_builder.h"

namespace rubble {

// A hole in a wall, and what fills it. Along the wall and upwards; unit: m.
struct Opening {
  double left = 0, right = 0, low = 0, high = 0;
  enum class Kind { window, door, shop } kind = Kind::window;
  int leaves = 2;      // casements beside each other
  double blind = 0;    // share from the top that a blind hides
  bool curtain = false;
  bool lit = false;
  int balcony = 0;     // before it: 0 none, 1 bars, 2 a parapet
};

// In the plane y = 0 of its frame, from x = 0 to width, looking to -y.
struct Facade {
  double width = 0;
  std::vector<Opening> openings;
};

struct WallLooks {
  std::string ground, upper;   // of the wall, to `ground_top` and above
  double ground_top = 0;       // unit: m
  std::string frame, door;     // of windows; of doors
};

// Every wall of a building is cut at all `heights`, so that walls meet in the same vertices.
void add_wall(const Facade& facade, const std::vector<double>& heights, const WallLooks& looks, MeshBuilder& out);
// What is in the holes, and before them.
void add_openings(const Facade& facade, const WallLooks& looks, MeshBuilder& out);
// The same from far: panes on an even wall.
void add_panes(const Facade& facade, MeshBuilder& out);

}  // namespace rubble
