// A mesh as few convex parts, for meshes that come without any.
//
// Where the mesh is a union of closed convex bodies, or of closed bodies with right angles alone (boxes
// put together, whether as one surface or as several), the parts are exactly these: decompose_exact.h.
//
// Of any other, the box around the mesh is cut again and again by planes across its axes where that saves most
// hull volume (approximate convex decomposition; compare Mamou and Ghorbel 2009 and later work, which
// cut the voxels as we do). Voxels only choose the planes: each part is the convex hull of the exact
// surface within its box, so parts touch the mesh, not its voxels. Neighbours whose common hull is
// hardly larger than the two are then one part again.
//
// The result depends on the mesh and the options alone, and is the same on every machine.
#pragma once

#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/pile.h"

namespace rubble {

struct DecomposeOptions {
  int max_parts = 16;       // range: 1 to 64
  double tolerance = 0.04;  // hulls are this share larger than what they hold, at most, when the
                            // number of parts allows it; range: 0.001 to 1
  int resolution = 48;      // voxels along the longest side; range: 8 to 128
  int max_corners = 32;     // of a part; range: 8 to 64
  double thinnest = 0.011;  // thinner parts are widened to this; unit: m

};

// Works for open meshes too, whose inside is then what cannot be reached from outside: it should
// have no hole larger than a voxel. Throws InputError when the mesh has no volume at all.
std::vector<ConvexPart> decompose(const TriangleMesh& mesh, const DecomposeOptions& options = {});

}  // namespace rubble
