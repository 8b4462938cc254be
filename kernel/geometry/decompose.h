// Divides a mesh into few convex parts, for meshes without collision parts.
//
// A union of closed convex bodies, or of closed bodies with right angles only (boxes joined in one or several
// surfaces), is divided into exactly these bodies: decomposing/decompose_exact.h.
//
// For all other meshes, planes across the axes cut the bounding box repeatedly, each where it removes most volume of
// hulls outside the mesh (approximate convex decomposition; Mamou and Ghorbel 2009 and later work cut voxels):
// decomposing/decompose_cells.h. Each part is the convex hull of the exact surface within its box. Parts whose common
// hull stays within the limits are joined again. Two limits keep hollows open: the volume of the parts outside the
// mesh, and the distance by which parts stand out of it. The second one protects small holes.
//
// The result depends on the mesh and the options only, and is the same on every machine.
#pragma once

#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/geometry/hull.h"
#include "kernel/model/pile.h"

namespace rubble {

struct DecomposeOptions {
  int max_parts = 16;        // intended number of parts; range: 1 to 64
  int most_parts = 64;       // upper limit, if max_parts cannot meet the limits below; range: max_parts to 64
  double tolerance = 0.04;   // parts are joined up to this volume outside the mesh, as a share of the mesh's volume;
                             // below max_parts in small increments; range: 0.001 to 1
  double most_outside = 0.08;  // above this share, parts are added beyond max_parts; range: tolerance to 1
  double most_gap = 0.015;   // parts are also added if one stands out of the mesh by more than this share of its longest
                             // side, or of four times its shortest if that is less; at least 6 mm; range: 0.005 to 1
  int resolution = 128;      // cells along a side for the measurement of misfits, see Solid; range: 8 to 256
  int max_corners = 64;      // of a part; range: 8 to 64
  double thinnest = 0.011;   // thinner parts are widened to this; unit: m
};

struct Decomposition {
  std::vector<ConvexPart> parts;
  bool exact = false;  // the parts are the mesh
  double volume = 0;   // of the mesh; unit: m3
  Misfit misfit;       // of the union of the parts
};

// Accepts open meshes: their inside is the space that cannot be reached from outside. Holes should be
// smaller than a cell. Throws InputError when the mesh has no volume.
Decomposition decompose(const TriangleMesh& mesh, const DecomposeOptions& options = {});

}  // namespace rubble
