// Which of the six axis directions a direction is nearest to.
#pragma once

#include <cmath>

#include "kernel/base/math.h"

namespace rubble {

// 0 to 5: +x, -x, +y, -y, +z, -z.
inline int dominant_direction(const Vec3f& n) {
  const float ax = std::fabs(n.x), ay = std::fabs(n.y), az = std::fabs(n.z);
  if (ax >= ay && ax >= az) return n.x > 0 ? 0 : 1;
  if (ay >= az) return n.y > 0 ? 2 : 3;
  return n.z > 0 ? 4 : 5;
}

}  // namespace rubble
