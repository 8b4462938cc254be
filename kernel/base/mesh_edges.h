// Why a mesh is not closed: the edges that lack a triangle or have one too many.
#pragma once

#include <cstddef>
#include <string>

#include "kernel/base/mesh.h"

namespace rubble {

struct OpenEdges {
  std::size_t count = 0;  // edges that are not used exactly once in each direction; 0: closed
  Vec3f from, to;         // of the first of them, in the order of the triangles; unit: m
  int triangles = 0;      // that share it
};

// Corners of equal position count as one, as for is_closed.
OpenEdges find_open_edges(const TriangleMesh& mesh);

// "3 edges are not shared by two triangles, the first, from (0, 0, 1) to (0, 2, 1), by 1"; of a mesh
// with open edges.
std::string describe(const OpenEdges& edges);

}  // namespace rubble
