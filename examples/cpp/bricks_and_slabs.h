// A pile of slabs and bricks: what is dropped.
#pragma once

#include <string>

#include <rubble/kernel/model/pile.h>

// A box of these edge lengths, unit: m. A piece is given by the corners of its convex parts.
inline rubble::PieceType make_box(const std::string& name, double x, double y, double z) {
  rubble::PieceType type;
  type.name = name;
  type.parts.resize(1);
  for (int k = 0; k < 8; ++k)
    type.parts[0].points.push_back({(k & 1 ? 0.5 : -0.5) * x, (k & 2 ? 0.5 : -0.5) * y, (k & 4 ? 0.5 : -0.5) * z});
  return type;
}

inline rubble::PileSpec make_spec(std::uint64_t seed) {
  rubble::PileSpec spec;
  spec.seed = seed;
  spec.types = {make_box("slab", 1.2, 0.8, 0.15), make_box("brick", 0.4, 0.2, 0.2)};
  spec.mix = {{0, 1.0}, {1, 3.0}};  // three bricks a slab
  spec.spawn_bounds = {3, 3, 3};
  spec.layers = 2;
  spec.pieces_per_layer = 40;
  return spec;
}
