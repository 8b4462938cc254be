// Sixteen single-precision lanes as they lie in memory, in one line of a cache; packets.h computes with
// them. Written with the vector extension of GCC and Clang.
#pragma once

#include <cstring>

#include "kernel/base/math.h"

// The optimiser gives up on inlining functions with this many registers in and out.
#define RUBBLE_INLINE [[gnu::always_inline]] inline

namespace rubble {

inline constexpr int kLanes = 16;  // contacts of a batch: one register of AVX-512, two of AVX2, or four

// Four lanes, in a register of any machine.
typedef float Quad __attribute__((vector_size(16)));
typedef int QuadMask __attribute__((vector_size(16)));
RUBBLE_INLINE Quad make_quad(float x) { return Quad{x, x, x, x}; }
RUBBLE_INLINE Quad load_quad(const float* from) {
  Quad q;
  std::memcpy(&q, from, sizeof q);
  return q;
}

struct alignas(64) Lanes {
  float lane[kLanes];

  float& operator[](int i) { return lane[i]; }
  float operator[](int i) const { return lane[i]; }
};

struct Lanes3 {
  Lanes x, y, z;

  void set(int i, const Vec3f& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  Vec3f get(int i) const { return {x[i], y[i], z[i]}; }
};

}  // namespace rubble
