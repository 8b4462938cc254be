// The rotation of a rigid body on which no torque acts.
#pragma once

#include "kernel/base/math.h"

namespace rubble {

struct FreeRotation {
  Quat rotation;  // world from body, after the step
  Vec3 angular;   // angular velocity in the world, after the step; unit: rad/s
};

// Euler's equations over the time dt by the implicit midpoint rule in the body's axes, in substeps of
// at most an eighth of a radian: it keeps the magnitude of the angular momentum and the energy, both
// quadratic, to rounding (Hairer, Lubich and Wanner, Geometric Numerical Integration, IV.2). The orientation
// is then turned by the little that keeps the momentum's direction in the world. Rules that find the
// velocity from the momentum in the world instead spin up thin bars: an angle of 1e-3 rad between bar
// and momentum is many times the bar's speed about its own axis.
// inertia: about the centre of mass, in the body, positive definite; unit: kg m2. angular: in the
// world; unit: rad/s.
FreeRotation rotate_freely(const Quat& world_from_body, const Mat3& inertia, const Vec3& angular,
                           double dt);

}  // namespace rubble
