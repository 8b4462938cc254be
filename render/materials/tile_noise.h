// Noise that repeats with a whole number of cells, so that textures tile without a seam.
#pragma once

#include <cstdint>

namespace rubble {

// A hash of a lattice point, uniform over [0, 1).
float lattice_value(int x, int y, std::uint32_t seed);

// Smooth value noise in [0, 1]; repeats every `cells` units in both directions.
float tile_noise(float x, float y, int cells, std::uint32_t seed);

// Octaves of tile_noise, each of twice the frequency and `gain` times the height of the one before,
// scaled to [0, 1]. `x` and `y` run over [0, 1) for one tile.
float tile_fractal(float x, float y, int cells, int octaves, float gain, std::uint32_t seed);

// Distances to the nearest two of a jittered grid of points (Worley 1996), and the nearest's value.
struct CellNoise {
  float nearest, second;  // unit: cell
  float value;            // random, the same all over the cell
};
CellNoise tile_cells(float x, float y, int cells, std::uint32_t seed);

}  // namespace rubble
