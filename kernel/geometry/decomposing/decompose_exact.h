// Inside of decompose(): meshes that can be cut into convex parts without any error.
#pragma once

#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble::decomposing {

// The corners of convex parts that are the mesh itself, where it consists of closed bodies each of which
// is either convex, of at most `max_corners` corners, or has only faces across three directions at right
// angles to each other, however they are turned: beams, frames, stairs. Such a body is cut into boxes
// along its own faces. Bodies may overlap. Empty: the mesh is another one, or needs more than
// `max_parts`.
std::vector<std::vector<Vec3>> find_exact_parts(const TriangleMesh& mesh, int max_parts,
                                                int max_corners);

}  // namespace rubble::decomposing
