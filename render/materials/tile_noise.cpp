#include "render/materials/tile_noise.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

int wrap(int x, int cells) {
  const int r = x % cells;
  return r < 0 ? r + cells : r;
}

float smooth(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

// The finalizer of MurmurHash3 (public domain) over a simple combination.
float lattice_value(int x, int y, std::uint32_t seed) {
  std::uint32_t h =
      std::uint32_t(x) * 0x9e3779b1u ^ std::uint32_t(y) * 0x85ebca77u ^ seed * 0xc2b2ae3du;
  h ^= h >> 16, h *= 0x85ebca6bu, h ^= h >> 13, h *= 0xc2b2ae35u, h ^= h >> 16;
  return float(h >> 8) * (1.0f / 16777216.0f);
}

float tile_noise(float x, float y, int cells, std::uint32_t seed) {
  const float fx = std::floor(x), fy = std::floor(y);
  const int x0 = wrap(int(fx), cells), y0 = wrap(int(fy), cells);
  const int x1 = wrap(x0 + 1, cells), y1 = wrap(y0 + 1, cells);
  const float u = smooth(x - fx), v = smooth(y - fy);
  const float a = lattice_value(x0, y0, seed), b = lattice_value(x1, y0, seed);
  const float c = lattice_value(x0, y1, seed), d = lattice_value(x1, y1, seed);
  return (a + (b - a) * u) * (1 - v) + (c + (d - c) * u) * v;
}

float tile_fractal(float x, float y, int cells, int octaves, float gain, std::uint32_t seed) {
  float sum = 0, height = 1, total = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += height * tile_noise(x * float(cells), y * float(cells), cells, seed + std::uint32_t(i));
    total += height;
    height *= gain;
    cells *= 2;
  }
  return sum / total;
}

CellNoise tile_cells(float x, float y, int cells, std::uint32_t seed) {
  x *= float(cells), y *= float(cells);
  const int cx = int(std::floor(x)), cy = int(std::floor(y));
  CellNoise out{9, 9, 0};
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const int wx = wrap(cx + i, cells), wy = wrap(cy + j, cells);
      const float px = float(cx + i) + lattice_value(wx, wy, seed);
      const float py = float(cy + j) + lattice_value(wx, wy, seed + 101);
      const float d = std::sqrt((px - x) * (px - x) + (py - y) * (py - y));
      if (d < out.nearest) {
        out.second = out.nearest;
        out.nearest = d;
        out.value = lattice_value(wx, wy, seed + 202);
      } else {
        out.second = std::min(out.second, d);
      }
    }
  }
  return out;
}

}  // namespace rubble
