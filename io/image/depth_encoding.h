// Depth as 16-bit integers, the way ROS (16UC1), MRPT and TUM store it.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace rubble {

// Rounds metres to multiples of `unit` (m). 0 means no return: for NaN, infinity, and for what is
// too far to be held (at 1 mm: beyond 65.535 m). A return nearer than half a unit becomes 1.
inline std::vector<std::uint16_t> encode_depth(const std::vector<float>& depth, double unit) {
  std::vector<std::uint16_t> encoded(depth.size(), 0);
  const double per_metre = 1.0 / unit;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double units = static_cast<double>(depth[i]) * per_metre + 0.5;
    // Written so that NaN fails it.
    if (depth[i] > 0 && units < 65536.0) {
      const auto whole = static_cast<std::uint16_t>(units);
      encoded[i] = whole > 0 ? whole : std::uint16_t{1};
    }
  }
  return encoded;
}

}  // namespace rubble
