// Binary STL.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

// One mesh placed in the world.
struct MeshInstance {
  const TriangleMesh* mesh = nullptr;  // never null; at scale 1
  double scale = 1;                    // of the mesh's lengths; above 0
  Pose world_from_body;                // frame of the mesh in the world; unit: m
};

// Writes binary STL: metres, right-handed, Z up, triangles in the order of the instances. Throws
// RunError when it cannot be written.
void write_stl(const std::string& path, const std::vector<MeshInstance>& instances);

// The bytes of such a file with one mesh. Fewer than 2^32 triangles.
std::string stl_bytes(const TriangleMesh& mesh);

}  // namespace rubble
