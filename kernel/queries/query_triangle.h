// One triangle in double precision: where a ray meets it, where it is closest, how large it looks.
#pragma once

#include <optional>

#include "kernel/base/math.h"

namespace rubble {

struct QueryTriangle {
  Vec3 a, b, c;  // counter-clockwise seen from outside
};

// The t >= 0 where the ray meets the triangle, from either side; in units of the direction. Rays in
// its plane miss it. It is larger by the rounding of doubles, so that no ray slips through edges or
// corners that triangles have in common.
std::optional<double> find_hit(const QueryTriangle& triangle, const Vec3& origin,
                               const Vec3& direction);

// Ericson, Real-Time Collision Detection (2005), 5.1.5.
Vec3 find_closest(const QueryTriangle& triangle, const Vec3& point);

// The signed solid angle seen from a point, over 4 pi: summed over a closed mesh it is 1 inside and
// 0 outside (van Oosterom and Strackee 1983).
double calc_winding(const QueryTriangle& triangle, const Vec3& point);

}  // namespace rubble
