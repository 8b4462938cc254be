// Reinforcing bars: round rods along a bent line, as meshes and as collision prisms.
#pragma once

#include <vector>

#include "assets/generator/surface_mesh.h"

namespace rubble::generator {

struct Bar {
  std::vector<Vec3> line;  // at least two points; a bend at each inner one; unit: m
  double radius = 0.006;   // unit: m
  double hidden = 0;       // length at the start that is buried in concrete; unit: m
  bool collides = true;    // false: drawn only
  Surface surface = Surface::rebar;
};

// A closed tube with `sides` sides whose bends are rounded and whose ends are flat. Level 0 has
// rolled-in unevenness; coarser levels have fewer rings.
SurfaceMesh mesh_bar(const Bar& bar, int sides, double ring_spacing);

// One square prism per straight stretch outside the concrete, with the section area of the rod: its
// faces lie 0.11 radii inside the rod and its edges 0.25 radii outside.
std::vector<std::vector<Vec3>> bar_parts(const Bar& bar);

}  // namespace rubble::generator
