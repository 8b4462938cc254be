// A box cut into convex fragments: the Voronoi cells of points that lie on a jittered grid.
#pragma once

#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/random.h"
#include "kernel/structure/polygon.h"

namespace rubble {

struct CutOptions {
  int counts[3] = {1, 1, 1};  // cells along X, Y and Z; range: 1 to 40
  double roughness = 0.3;     // how far points leave the grid, of its spacing; range: 0 to 0.45
  double gap = 0.001;         // between neighbours as they collide; unit: m; range: 0 to 0.01
  // Slope of the cuts of what is cut along one axis, against the plane across it, all through that axis: 1 is
  // 45 degrees. Each box has a direction of its own. 0: as roughness leaves them. range: 0 to 3
  double slope = 0;
};

// One flat side of a fragment. As it was cut, without the gap: sections are measured on it.
struct FragmentFace {
  HalfSpace plane;     // the fragment is inside of it
  Polygon polygon;     // corners of the side, seen from outside counter-clockwise; unit: m
  int neighbour = -1;  // the fragment of the same box on its other side; -1: the box ends here
};

struct Fragment {
  std::vector<Vec3> corners;        // of what collides, half a gap inside; unit: m, from the box's centre
  std::vector<FragmentFace> faces;  // in no order of meaning
};

// size: edge lengths; unit: m; > 0. The box is centred at the origin. Neighbours share a plane exactly.
std::vector<Fragment> cut_box(const Vec3& size, const CutOptions& options, RandomStream& random);

}  // namespace rubble
