// Four single-precision lanes, and vectors of them. Written with the vector extension of GCC and
// Clang: every lane is computed by the plain IEEE operations in the order written, on any machine.
#pragma once

#include <cmath>

#include "kernel/base/math.h"

// The optimiser gives up on inlining functions with this many registers in and out.
#define RUBBLE_INLINE [[gnu::always_inline]] inline

namespace rubble {

typedef float Wide __attribute__((vector_size(16)));
typedef int WideMask __attribute__((vector_size(16)));

inline constexpr int kLanes = 4;

RUBBLE_INLINE Wide splat(float x) { return Wide{x, x, x, x}; }
RUBBLE_INLINE Wide select(WideMask mask, Wide a, Wide b) { return mask ? a : b; }
RUBBLE_INLINE bool any(WideMask m) { return (m[0] | m[1] | m[2] | m[3]) != 0; }
RUBBLE_INLINE Wide max(Wide a, Wide b) { return a > b ? a : b; }
RUBBLE_INLINE Wide min(Wide a, Wide b) { return a < b ? a : b; }
RUBBLE_INLINE Wide sqrt(Wide a) {
  return Wide{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

struct Wide3 {
  Wide x, y, z;

  void set(int lane, const Vec3f& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
  Vec3f get(int lane) const { return {x[lane], y[lane], z[lane]}; }
  Wide3& operator+=(const Wide3& v) { return x += v.x, y += v.y, z += v.z, *this; }
  Wide3& operator-=(const Wide3& v) { return x -= v.x, y -= v.y, z -= v.z, *this; }
};
RUBBLE_INLINE Wide3 operator+(const Wide3& a, const Wide3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
RUBBLE_INLINE Wide3 operator-(const Wide3& a, const Wide3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
RUBBLE_INLINE Wide3 operator*(const Wide3& a, Wide s) { return {a.x * s, a.y * s, a.z * s}; }
RUBBLE_INLINE Wide dot(const Wide3& a, const Wide3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Rows to columns: lane i of the k-th result is element k of the i-th argument.
RUBBLE_INLINE void transpose(Wide& a, Wide& b, Wide& c, Wide& d) {
  const Wide t0 = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Wide t1 = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Wide t2 = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Wide t3 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(t0, t1, 0, 1, 4, 5);
  b = __builtin_shufflevector(t0, t1, 2, 3, 6, 7);
  c = __builtin_shufflevector(t2, t3, 0, 1, 4, 5);
  d = __builtin_shufflevector(t2, t3, 2, 3, 6, 7);
}

}  // namespace rubble
