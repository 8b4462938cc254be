// Makes a mesh fit for drawing and baking: welded, with a normal at every vertex, and without long
// edges, so that light stored at vertices can vary along a large flat face. The surface stays.
#pragma once

#include "kernel/base/mesh.h"

namespace rubble {

// Every vertex gets a normal; a mesh without normals gets one per flat face. Equal vertices are
// merged. Triangles without area are dropped. Edges longer than `longest_edge` (unit: m) are halved
// until none is; a shared edge is cut in the same places from both sides, so no cracks appear.
TriangleMesh refine_mesh(const TriangleMesh& mesh, float longest_edge);

}  // namespace rubble
