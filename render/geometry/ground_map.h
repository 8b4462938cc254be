// The ground as seen from above: where fines and dust of the debris lie, and how its tone varies.
#pragma once

#include <cstdint>
#include <vector>

#include "render/geometry/geometry.h"

namespace rubble {

// A square map of the whole plane, fine near the pile and ever coarser away from it: per axis
// s = 0.5 + 0.5 a / (1 + |a|), where a = (x - centre) / reach.
struct GroundMap {
  static constexpr int kSide = 256;  // unit: texel
  float x = 0, y = 0;                // its centre; unit: m
  float reach = 1;                   // unit: m
  std::vector<std::uint8_t> texels;  // debris (0: none, 255: all covered) and tone; rows
};

// Fines lie under and around what lies low: out to about 0.7 m from a piece, more around many.
GroundMap make_ground_map(const PreparedScene& scene);

}  // namespace rubble
