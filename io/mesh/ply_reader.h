// Point clouds and meshes that others wrote as PLY.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct PlyMesh {
  std::vector<Vec3> positions;                          // in the file's own unit and frame
  std::vector<std::array<std::uint32_t, 3>> triangles;  // polygons as fans; empty: a point cloud
};

// Reads ascii and binary little-endian PLY: x, y and z of the element `vertex`, and of `face` the
// list vertex_indices (or vertex_index); everything else is passed over. assimp, behind
// io/mesh/mesh_file.h, takes no point clouds. Throws InputError with file and line (header, ascii) or
// byte (binary) for: another format, a vertex without x, y or z, a number that is not finite, a
// corner that is not there, a file that ends early, no vertex at all.
PlyMesh load_ply(const std::string& path);

}  // namespace rubble
