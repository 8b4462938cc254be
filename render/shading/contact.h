// The shadows of the lamp, at half the image's size: the formulas of shaders/contact.frag.glsl, which says how they work.
#pragma once

#include "render/shading/wide_math.h"
#include "render/shading/wide_shader.h"

namespace rubble::RUBBLE_ISA {

// Lanes are blocks of four columns.
RUBBLE_INLINE Int lane_columns() {
  Int out;
  for (int i = 0; i < kWidth; ++i) out[i] = i & 3;
  return out;
}
RUBBLE_INLINE Int lane_rows() {
  Int out;
  for (int i = 0; i < kWidth; ++i) out[i] = i >> 2;
  return out;
}
inline constexpr int kLaneRows = kWidth / 4;

// The way from the surface to a spot of the lamp is followed on the depth image: the lamp is close
// to the lens, so what stands between is seen.
RUBBLE_INLINE Real lamp_visible(const ContactData& c, Real px, Real py, Real z, Int spot,
                                Real part) {
  const float last_x = float(c.width - 1), last_y = float(c.height - 1);
  const Real x = (px - c.cx) * (1.0f / c.fx) * z, y = (py - c.cy) * (1.0f / c.fy) * z;
  const Real to_x = c.lamp[0] + gather(c.lamp_cosine, spot) * c.lamp_radius - x;
  const Real to_y = c.lamp[1] + gather(c.lamp_sine, spot) * c.lamp_radius - y;
  const Real to_z = c.lamp[2] - z;
  Real clear = real(1);
  for (int i = 0; i < ContactData::kLampSteps; ++i) {
    const Real s = (float(i) + part) * (4.0f / float(ContactData::kLampSteps));
    const Real way = s * s / (1.0f + s * s);
    const Real qx = x + to_x * way, qy = y + to_y * way, qz = z + to_z * way;
    const Real inverse = 1.0f / max(qz, 1e-3f);
    const Real at_x = qx * inverse * c.fx + c.cx, at_y = qy * inverse * c.fy + c.cy;
    const Mask known = Mask(qz > 0.02f) & Mask(at_x >= 0.0f) & Mask(at_x <= last_x) &
                       Mask(at_y >= 0.0f) & Mask(at_y <= last_y);
    const Int column = to_int(clamp(at_x, 0.0f, last_x) + 0.5f),
              row = to_int(clamp(at_y, 0.0f, last_y) + 0.5f);
    const Real there = c.near / max(gather(c.depth_values, row * c.width + column), 1e-9f);
    const Mask hides = Mask(there < qz * 0.985f - 0.008f) & Mask(there > qz * 0.6f - 0.2f);
    clear = select(known & hides, real(0), clear);
  }
  return clear;
}

RUBBLE_INLINE Real find_block(const ContactData& c, int x0, int y0) {
  const Int column = min(lane_columns() + x0, integer(c.half_width - 1));
  const Int row = min(lane_rows() + y0, integer(c.half_height - 1));
  const Int px = min(column * 2, integer(c.width - 1)), py = min(row * 2, integer(c.height - 1));
  const Int cell_x = column & 3, cell_y = row & 3;
  const Real z = c.near / max(gather(c.depth_values, py * c.width + px), 1e-9f);
  const Real part = to_real((cell_x * 5 + cell_y * 11) & 15) * 0.0625f;
  return lamp_visible(c, to_real(px), to_real(py), z, (cell_x * 7 + cell_y * 4) & 15, part);
}

// Rows [first, last) of the grid, by four.
inline void find_contacts(const ContactData& c, int first, int last) {
  for (int y = first; y < last; y += kLaneRows) {
    for (int x = 0; x < c.half_width; x += 4) {
      const Real lamp = find_block(c, x, y);
      // The rows of the grid are padded to whole blocks.
      for (int i = 0; i < kLaneRows && y + i < last; ++i)
        std::memcpy(c.lamp_seen + std::ptrdiff_t(y + i) * c.stride + x, reinterpret_cast<const char*>(&lamp) + i * 16, 16);
    }
  }
}

}  // namespace rubble::RUBBLE_ISA
