// Boxes made to measure while a mission loads: walls, floors and blocks of exact size.
//
// Far cheaper than sampling a field, so that a slab of any size costs milliseconds: a lattice over
// the six faces, whose edges are worn and chipped and whose broken faces are dented. As in
// solid.h, wear only ever removes, so the exact box is the collision part.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "assets/generator/solid.h"
#include "kernel/base/mesh.h"

namespace rubble::generator {

struct BoxRecipe {
  Vec3 size{1, 1, 1};            // full edge lengths; unit: m; range: 0.02 to 100
  Surface surface = Surface::concrete_cast;
  std::array<bool, 6> broken{};  // +x, -x, +y, -y, +z, -z: rough, as if broken off
  std::uint32_t seed = 0;        // of the wear
};

// Closed meshes about the middle of the box, finest first.
std::vector<TriangleMesh> make_box(const BoxRecipe& recipe);

// The face of that look (surface_name()); cast concrete where there is none.
Surface surface_of_look(const std::string& look);

}  // namespace rubble::generator
