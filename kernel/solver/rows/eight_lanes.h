// A packet that is one register of AVX2. To be included in a region for it (target_region.h).
#pragma once

#include <immintrin.h>

#include "kernel/solver/rows/whole_lanes.h"
#include "kernel/solver/rows/whole_motions.h"

namespace rubble {

// max and min return the second of two that are equal, and where one is not a number.
struct EightRegister {
  static constexpr int width() { return 8; }
  using Vector = __m256;
  using Mask = __m256;

  RUBBLE_INLINE static Vector all(float x) { return _mm256_set1_ps(x); }
  RUBBLE_INLINE static Vector load(const float* from) { return _mm256_load_ps(from); }
  RUBBLE_INLINE static void store(float* to, Vector a) { _mm256_store_ps(to, a); }
  RUBBLE_INLINE static Mask is_larger(Vector a, Vector b) { return _mm256_cmp_ps(a, b, _CMP_GT_OQ); }
  RUBBLE_INLINE static Mask is_not_smaller(Vector a, Vector b) {
    return _mm256_cmp_ps(a, b, _CMP_GE_OQ);
  }
  RUBBLE_INLINE static Mask is_equal(Vector a, Vector b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
  RUBBLE_INLINE static Vector select(Mask m, Vector a, Vector b) { return _mm256_blendv_ps(b, a, m); }
  RUBBLE_INLINE static Vector max(Vector a, Vector b) { return _mm256_max_ps(a, b); }
  RUBBLE_INLINE static Vector min(Vector a, Vector b) { return _mm256_min_ps(a, b); }
  RUBBLE_INLINE static Vector root(Vector a) { return _mm256_sqrt_ps(a); }
  RUBBLE_INLINE static bool any(Mask m) { return _mm256_movemask_ps(m) != 0; }

  // Every fourth row, from row k on.
  template <typename Row>
  RUBBLE_INLINE static Vector join_rows(const Row& row, int k) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(__m128(row(k))), __m128(row(k + 4)), 1);
  }
  // transpose() in each quarter of four lanes.
  RUBBLE_INLINE static void transpose(Vector& a, Vector& b, Vector& c, Vector& d) {
    const Vector t0 = _mm256_unpacklo_ps(a, b), t1 = _mm256_unpacklo_ps(c, d);
    const Vector t2 = _mm256_unpackhi_ps(a, b), t3 = _mm256_unpackhi_ps(c, d);
    a = _mm256_shuffle_ps(t0, t1, 0x44), b = _mm256_shuffle_ps(t0, t1, 0xEE);
    c = _mm256_shuffle_ps(t2, t3, 0x44), d = _mm256_shuffle_ps(t2, t3, 0xEE);
  }
  // Eight numbers of a body, from octet(k) and to write(k, octet).
  template <typename Octet>
  RUBBLE_INLINE static Vector join_octets(const Octet& octet, int k) {
    return octet(k);
  }
  template <typename Write>
  RUBBLE_INLINE static void split_octets(Vector a, int k, const Write& write) {
    write(k, a);
  }
  // The first quarters of both, or the second ones.
  RUBBLE_INLINE static Vector even_quarters(Vector a, Vector b) {
    return _mm256_permute2f128_ps(a, b, 0x20);
  }
  RUBBLE_INLINE static Vector odd_quarters(Vector a, Vector b) {
    return _mm256_permute2f128_ps(a, b, 0x31);
  }
  // The way back.
  RUBBLE_INLINE static Vector mix_low(Vector a, Vector b) { return even_quarters(a, b); }
  RUBBLE_INLINE static Vector mix_high(Vector a, Vector b) { return odd_quarters(a, b); }
};

using EightLanes = WholeLanes<EightRegister>;

}  // namespace rubble
