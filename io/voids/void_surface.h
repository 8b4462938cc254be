// The surface of a void as a mesh.
#pragma once

#include <string>

#include "kernel/base/mesh.h"
#include "kernel/voids/void_map.h"

namespace rubble {

// Around the cells that the robot covers, smoothed over about a voxel; closed, outward, welded.
TriangleMesh make_void_surface(const VoidSpace& space, const Void& v);

// Binary little-endian PLY: positions (float, metres, world frame) and triangles. Throws RunError.
void write_ply(const std::string& path, const TriangleMesh& mesh);

}  // namespace rubble
