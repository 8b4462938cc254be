// Chains and frames of jointed boxes, for the tests of articulated debris.
#pragma once

#include <cmath>

#include "closed_forms.h"
#include "kernel/world/world.h"
#include "scenes.h"

namespace rubble::testing {

inline const Quat kAboutY{std::sqrt(0.5), -std::sqrt(0.5), 0, 0};  // takes Z to Y

// `count` boxes of size x, y, z along -Z or X, joined end to end; link 0 is a small block.
AssemblyType make_chain(int count, double length, bool along_x, const JointType& joint);
JointType joint_of(JointKind kind);
// A world of one assembly of blocks (type 0) and bars (type 1) of that length and thickness; unit: m.
World make_world(const AssemblyType& assembly, double length, const WorldOptions& options,
                 double thickness = 0.02);
// The assembly, its root fixed.
NewPiece hung(const Vec3& position, const Quat& rotation = {});
// Mean time between two crossings of x = 0 in the same direction; unit: s.
double measure_period(World& world, int piece, double seconds);

}  // namespace rubble::testing
