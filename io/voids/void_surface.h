// The surface of a void as a mesh.
#pragma once

#include "kernel/base/mesh.h"
#include "kernel/voids/void_map.h"

namespace rubble {

// Around the cells that the robot covers, smoothed over about a voxel; closed, outward, welded.
TriangleMesh make_void_surface(const VoidSpace& space, const Void& v);

}  // namespace rubble
