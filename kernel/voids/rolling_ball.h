// The ball that parts the outside from the voids, see void_space.h. Internal to kernel/voids.
#pragma once

#include "kernel/base/parallel.h"
#include "kernel/voids/void_space.h"

namespace rubble {

// Marks as outside all free cells that a ball of `rolling_radius` sweeps. space: its cells are
// solid or void so far, its clearance is that to the pieces alone. ground: whether the lowest cells
// lie on the ground, from where no ball comes.
void sweep_outside(VoidSpace& space, bool ground, ThreadPool& pool);

// The first step of it: marks as outside the places that the ball's centre can reach.
void roll_ball(VoidSpace& space, bool ground);

}  // namespace rubble
