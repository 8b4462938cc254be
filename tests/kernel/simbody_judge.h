// Simbody by itself as the judge of our stepping: its own mobilizers, its own gravity, and its
// Runge-Kutta-Merson integrator at high accuracy.
#pragma once

#include <vector>

#include "kernel/collision/body.h"
#include "kernel/multibody/tree.h"

namespace rubble::testing {

// By link: where it is after `seconds`. Trees without springs.
std::vector<Pose> integrate_with_simbody(const Tree& tree, const std::vector<Body>& bodies,
                                         const TreeState& state, double gravity, double seconds);

// du/dt at the state, in the order of the tree's speeds.
std::vector<double> accelerate_with_simbody(const Tree& tree, const std::vector<Body>& bodies,
                                            const TreeState& state, double gravity);

}  // namespace rubble::testing
