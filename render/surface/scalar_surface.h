// The models of surfaces and of tone for one point: with the bits that lanes of pixels have.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernel/base/math.h"

#ifndef RUBBLE_INLINE
#define RUBBLE_INLINE [[gnu::always_inline]] inline
#endif

namespace rubble::scalar {

typedef float Real;
typedef std::int32_t Int;
typedef bool Mask;

RUBBLE_INLINE Real real(float x) { return x; }
RUBBLE_INLINE Real real_from_bits(Int i) {
  Real x;
  std::memcpy(&x, &i, sizeof x);
  return x;
}
RUBBLE_INLINE Int bits_of(Real x) {
  Int i;
  std::memcpy(&i, &x, sizeof i);
  return i;
}
RUBBLE_INLINE Mask both(Mask a, Mask b) { return a && b; }
RUBBLE_INLINE Real to_real(Int i) { return float(i); }
RUBBLE_INLINE Int to_int(Real x) { return Int(x); }  // towards zero
RUBBLE_INLINE Real select(Mask m, Real a, Real b) { return m ? a : b; }
RUBBLE_INLINE Real min(Real a, Real b) { return a < b ? a : b; }
RUBBLE_INLINE Real max(Real a, Real b) { return a > b ? a : b; }
RUBBLE_INLINE Real clamp(Real x, float low, float high) { return min(max(x, low), high); }
RUBBLE_INLINE Real abs(Real x) { return std::fabs(x); }
RUBBLE_INLINE Real sqrt(Real x) { return std::sqrt(x); }
RUBBLE_INLINE Real floor(Real x) { return std::floor(x); }

#include "render/surface/real_math.inl"

#define FN inline
#include "render/shaders/surface_model.glsl"
#include "render/shaders/tone.glsl"
#undef FN

RUBBLE_INLINE Real3 real3(const Vec3f& v) { return {v.x, v.y, v.z}; }
RUBBLE_INLINE Vec3f to_vec3(const Real3& v) { return {v.x, v.y, v.z}; }

}  // namespace rubble::scalar
