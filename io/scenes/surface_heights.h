// Surfaces of triangles as heights on a grid, for engines whose contacts know no other open surface.
#pragma once

#include <vector>

#include "io/scenes/sim_scene.h"

namespace rubble {

struct SurfaceHeights {
  int columns = 0, rows = 0;  // of corners; 0: there is no surface
  double spacing = 0;         // unit: m
  Vec3 low;                   // of the corner with the lowest x and y; z: the lowest height; unit: m
  double range = 0;           // highest less lowest height; unit: m
  std::vector<float> shares;  // of `range`, 0 to 1; row by row from the lowest y
};

// The highest surface over each corner; where there is none, a little below the ground z = 0. spacing: unit: m; becomes
// wider where more than kMostHeightCorners along a side would be needed.
SurfaceHeights calc_surface_heights(const std::vector<SimSurface>& surfaces, double spacing);
inline constexpr int kMostHeightCorners = 1000;

}  // namespace rubble
