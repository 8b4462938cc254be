// How far the centres of cells are from the surface of a pile. Internal to kernel/voids.
#pragma once

#include <functional>

#include "kernel/base/parallel.h"
#include "kernel/voids/solid_voxels.h"
#include "kernel/voids/void_space.h"

namespace rubble {

// Sets the clearance of all cells that it is kept of, from the pieces alone. space: its solids are known.
// report: called with the share that is done, 0 to 1.
void measure_clearance(VoidSpace& space, const Solids& solids, ThreadPool& pool,
                       const std::function<void(double)>& report);

}  // namespace rubble
