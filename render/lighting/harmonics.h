// Real spherical harmonics to the third order: a function of direction as sixteen numbers. Term l l + l + m has
// order l; the norm of each is 1.
#pragma once

#include <array>
#include <cstddef>

#include "kernel/base/math.h"

namespace rubble {

inline constexpr std::size_t kHarmonics = 16;
inline constexpr std::size_t kOrders = 4;  // l = 0 to 3
using Harmonics = std::array<float, kHarmonics>;

// direction: unit length.
inline Harmonics harmonics_of(const Vec3f& d) {
  const float x = d.x, y = d.y, z = d.z, z2 = z * z;
  return {0.2820948f,
          0.4886025f * y,
          0.4886025f * z,
          0.4886025f * x,
          1.0925484f * x * y,
          1.0925484f * y * z,
          0.3153916f * (3 * z2 - 1),
          1.0925484f * x * z,
          0.5462742f * (x * x - y * y),
          0.5900436f * y * (3 * x * x - y * y),
          2.8906114f * x * y * z,
          0.4570458f * y * (5 * z2 - 1),
          0.3731763f * z * (5 * z2 - 3),
          0.4570458f * x * (5 * z2 - 1),
          1.4453057f * z * (x * x - y * y),
          0.5900436f * x * (x * x - 3 * y * y)};
}

constexpr std::size_t order_of(std::size_t term) { return term < 1 ? 0 : term < 4 ? 1 : term < 9 ? 2 : 3; }

}  // namespace rubble
