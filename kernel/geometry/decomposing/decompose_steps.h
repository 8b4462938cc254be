// Inside of decompose(): its two ways from a mesh to convex parts.
#pragma once

#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"
#include "kernel/geometry/decomposing/solid.h"

namespace rubble::decomposing {

// Meshes that can be cut into convex parts without any error.

// The corners of convex parts that are the mesh itself, where it consists of closed bodies each of which
// is either convex, of at most `max_corners` corners, or has only faces across three directions at right
// angles to each other, however they are turned: beams, frames, stairs. Such a body is cut into boxes
// along its own faces. Bodies may overlap. Empty: the mesh is another one, or needs more than
// `max_parts`.
std::vector<std::vector<Vec3>> find_exact_parts(const TriangleMesh& mesh, int max_parts,
                                                int max_corners);

// A solid cut into boxes, each with what it holds of the surface.

// What the solid has in one box: the hull of the points is the smallest convex part that holds it.
struct Piece {
  std::vector<Vec3> points;
  Misfit misfit;  // of the hull
};

struct CutLimits {
  std::size_t most = 96;     // boxes
  double volume = 0;         // what the hulls may hold together outside the solid; unit: m3
  double gap = 0;            // how far a hull may stand out of the solid; unit: m
};

// Cuts the box around the mesh by planes across the axes, each time the box whose hull fits worst, where that saves
// most, until the limits are kept. Planes through edges at which the solid is concave are tried first: cut there, a
// solid with plane faces falls into convex pieces without any error.
std::vector<Piece> cut_into_boxes(const TriangleMesh& mesh, const Solid& solid, const CutLimits& limits);

}  // namespace rubble::decomposing
