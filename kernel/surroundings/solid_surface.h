// The solid surface of the surroundings, for contacts of robots.
#pragma once

#include "kernel/base/mesh.h"
#include "kernel/model/surroundings.h"

namespace rubble {

// All that is solid of what comes nearer than `reach` to the Z axis, as one surface in the world, by the triangles that
// are drawn: without leaves, tufts, puddles and the skyline. Empty where nothing is there. reach: unit: m
TriangleMesh make_solid_surface(const Surroundings& surroundings, double reach);

// As robots feel it.
inline constexpr double kFeltReach = 60;              // about the Z axis; unit: m
inline constexpr double kSurroundingsFriction = 0.8;  // of asphalt and walls, as of concrete; unit: 1

}  // namespace rubble
