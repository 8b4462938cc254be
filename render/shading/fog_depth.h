// Optical depth of fog that thins with height, as Air::fog_depth().
#pragma once

#include "render/shading/wide_math.h"

namespace rubble::RUBBLE_ISA {

// Along a straight line from a height z. rate: 1 / height in which it thins by e; 0: it does not.
RUBBLE_INLINE Real fog_depth(float density, float rate, Real z, Real slope, Real way) {
  const Real even = density * way;
  if (rate <= 0) return even;
  const Real end = z + slope * way;
  const Mask below = Mask(z < 0.0f), ends_below = Mask(end < 0.0f);
  const Mask all_below = Mask(z <= 0.0f) & Mask(end <= 0.0f), partly = below | ends_below;
  // The part below the ground, where it is even.
  const Real steep = select(partly, slope, real(1));
  const Real low = select(partly, select(below, -z / steep, end / steep), real(0));
  const Real above = select(partly, way - low, way), from = select(partly, max(z, 0.0f), z);
  const Real x = slope * above * rate;
  const Mask level = abs(x) < 1e-2f;
  const Real mean = select(level, 1.0f - x * (0.5f - x * (1.0f / 6)),
                           (1.0f - exp(-x)) / select(level, real(1), x));
  return select(all_below, even, density * (low + above * exp(-from * rate) * mean));
}

}  // namespace rubble::RUBBLE_ISA
