// What balls at places of a coarse grid cover of a finer one. Internal to kernel/voids.
#pragma once

#include "kernel/base/parallel.h"
#include "kernel/voids/void_space.h"

namespace rubble {

// Marks as outside all cells of the map that lie in a ball about a place of `balls`. Places are its cells outside. Each ball
// is as large as the clearance there, which is at least the rolling radius, and a voxel of the map larger, because the
// centres of cells stand off the surface that the ball touches by up to that.
void cover_by_balls(const VoidSpace& balls, VoidSpace& map, ThreadPool& pool);

}  // namespace rubble
