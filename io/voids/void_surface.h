// The surface of a void as a mesh.
#pragma once

#include <cstdint>
#include <string>

#include "kernel/base/mesh.h"
#include "kernel/voids/void_map.h"

namespace rubble {

// Around the cells that the robot covers, smoothed over about a voxel; closed, outward, welded.
TriangleMesh make_void_surface(const VoidSpace& space, const Void& v);

// Binary little-endian PLY: positions (float, metres, world frame) and triangles, with the pile's state hash as a
// comment. Throws RunError.
void write_void_surface(const std::string& path, const TriangleMesh& mesh, std::uint64_t pile_state);

// Whether such a file says that it is of this pile. Throws InputError when it cannot be read.
bool is_void_surface_of(const std::string& path, std::uint64_t pile_state);

}  // namespace rubble
