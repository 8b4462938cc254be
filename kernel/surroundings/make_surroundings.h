// Makes the surroundings of a pile from the seed.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/surroundings.h"

namespace rubble {

// A level circle; unit: m.
struct Circle {
  double x = 0, y = 0, radius = 0;
};

// Around all pieces that are not lost, about the middle of the box around them. meshes: by type.
Circle find_pile_circle(const PileState& pile, const std::vector<const TriangleMesh*>& meshes);

// Nothing of them but the ground plane's own height lies within the circle and the clearance about it.
// dark: what StreetLampState::automatic goes by. wetness: share of the places for puddles that have one. Empty for
// SurroundingsType::none.
Surroundings make_surroundings(const SurroundingsSpec& spec, std::uint64_t seed, const Circle& pile, bool dark,
                               double wetness);

// The solid surface of the surroundings, for contacts of robots.

// All that is solid of what comes nearer than `reach` to the Z axis, as one surface in the world, by the triangles that
// are drawn: without leaves, tufts, puddles and the skyline. Empty where nothing is there. reach: unit: m
TriangleMesh make_solid_surface(const Surroundings& surroundings, double reach);

// As robots feel it.
inline constexpr double kFeltReach = 60;              // about the Z axis; unit: m
inline constexpr double kSurroundingsFriction = 0.8;  // of asphalt and walls, as of concrete; unit: 1

}  // namespace rubble
