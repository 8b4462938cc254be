// The grids of a void map, and whether they fit into memory. Internal to kernel/voids.
#pragma once

#include "kernel/voids/solid_voxels.h"
#include "kernel/voids/void_space.h"

namespace rubble {

struct VoidGrids {
  VoxelGrid map;   // of the result
  VoxelGrid ball;  // in which the ball rolls: all pieces, with room for it

  bool is_one() const { return map.voxel == ball.voxel; }  // both are the same
};

VoidGrids plan_grids(const Solids& solids, const VoidSpaceOptions& options);

// The smallest voxel, not below that of the options, whose map takes no more than the memory limit; unit: m
double fitting_voxel(const Solids& solids, const VoidSpaceOptions& options);

// Throws InputError, with a voxel size that fits, where the map takes more than the limit.
void check_memory(const Solids& solids, const VoidSpaceOptions& options);

}  // namespace rubble
