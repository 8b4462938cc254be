// A void map as an OctoMap: solid is occupied, void is free, everything else is unknown.
#pragma once

#include <string>

#include "kernel/voids/void_space.h"

namespace rubble {

// Binary .bt with the grid's voxel as resolution. OctoMap's leaves lie on multiples of the
// resolution, as do the voxels. Throws RunError.
void write_octomap(const std::string& path, const VoidSpace& space);

}  // namespace rubble
