// A mesh as few convex parts, for meshes that come without any.
//
// Where the mesh is a union of closed convex bodies, or of closed bodies with right angles alone (boxes
// put together, whether as one surface or as several), the parts are exactly these: decomposing/decompose_exact.h.
//
// Of any other, the box around the mesh is cut again and again by planes across its axes where that saves most
// volume of hulls outside the mesh (approximate convex decomposition; compare Mamou and Ghorbel 2009 and later
// work, which cut voxels): decomposing/decompose_cells.h. Each part is the convex hull of the exact surface within its box.
// Parts whose common hull stays within the limits are then one part again. Hollows stay open: of two limits, on
// the volume of the parts outside the mesh and on how far they stand out of it, the second holds for small holes.
//
// The result depends on the mesh and the options alone, and is the same on every machine.
#pragma once

#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/geometry/hull.h"
#include "kernel/model/pile.h"

namespace rubble {

struct DecomposeOptions {
  int max_parts = 16;        // aimed at; range: 1 to 64
  int most_parts = 64;       // where fewer would not keep to the limits below; range: max_parts to 64
  double tolerance = 0.04;   // parts are joined up to this volume outside the mesh, as a share of the mesh's, and
                             // below max_parts a little at a time; range: 0.001 to 1
  double most_outside = 0.08;  // likewise, for which parts are added beyond max_parts; range: tolerance to 1
  double most_gap = 0.015;   // how far a part may stand out of the mesh, as a share of its longest side or a quarter of
                             // its shortest, for which parts are added too; 6 mm in any case; range: 0.005 to 1
  int resolution = 128;      // of the cells by which misfits are measured, see Solid; range: 8 to 256
  int max_corners = 64;      // of a part; range: 8 to 64
  double thinnest = 0.011;   // thinner parts are widened to this; unit: m
};

struct Decomposition {
  std::vector<ConvexPart> parts;
  bool exact = false;  // the parts are the mesh
  double volume = 0;   // of the mesh; unit: m3
  Misfit misfit;       // of the union of the parts
};

// Works for open meshes too, whose inside is then what cannot be reached from outside: it should
// have no hole larger than such a cell. Throws InputError when the mesh has no volume at all.
Decomposition decompose(const TriangleMesh& mesh, const DecomposeOptions& options = {});

}  // namespace rubble
