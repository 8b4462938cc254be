// A cell of a grid without bounds as one number.
#pragma once

#include <cmath>
#include <cstdint>

#include "kernel/base/math.h"

namespace rubble {

// Coordinates in cells: within 2^20 of zero.
inline std::int64_t space_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t kHalf = 1 << 20;
  return ((x + kHalf) << 42) | ((y + kHalf) << 21) | (z + kHalf);
}

inline std::int64_t space_index(double v, double cell) { return std::int64_t(std::floor(v / cell)); }

inline std::int64_t space_key_of(const Vec3& p, double cell) {
  return space_key(space_index(p.x, cell), space_index(p.y, cell), space_index(p.z, cell));
}

// How far from the origin a point may be for a key with cells of a centimetre; unit: m.
inline constexpr double kSpaceReach = 1e4;
inline bool has_space_key(const Vec3& p) {
  return std::abs(p.x) < kSpaceReach && std::abs(p.y) < kSpaceReach && std::abs(p.z) < kSpaceReach;
}

}  // namespace rubble
