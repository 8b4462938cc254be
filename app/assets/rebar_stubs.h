// Bars that stick out of the broken faces of a building's pieces.
#pragma once

#include <string>

#include "kernel/base/mesh.h"
#include "kernel/model/pile.h"
#include "kernel/structure/structure.h"

namespace rubble {

// Adds to a piece's mesh, as surface number `surface`, the bars that cross its broken faces: along the
// face's edges at the depth of the cover, bent towards its middle, each of its own length. While the piece
// still stands beside its neighbour they are inside of that one, where nobody sees them. Nothing where the
// member has no bars. seed_name: of the stream that lengths and bends are drawn from.
void add_rebar_stubs(const PieceType& type, const Reinforcement& bars, const std::string& seed_name,
                     std::uint8_t surface, TriangleMesh& mesh);

}  // namespace rubble
