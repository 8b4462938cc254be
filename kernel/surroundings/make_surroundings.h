// Makes the surroundings of a pile from the seed.
#pragma once

#include <cstdint>
#include <vector>

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

}  // namespace rubble
