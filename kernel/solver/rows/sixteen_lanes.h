// A packet that is one register of AVX-512. To be included in a region for it (target_region.h).
#pragma once

#include <immintrin.h>

#include "kernel/solver/rows/whole_lanes.h"
#include "kernel/solver/rows/whole_motions.h"

namespace rubble {

// max and min return the second of two that are equal, and where one is not a number.
struct SixteenRegister {
  static constexpr int width() { return 16; }
  using Vector = __m512;
  using Mask = __mmask16;

  RUBBLE_INLINE static Vector all(float x) { return _mm512_set1_ps(x); }
  RUBBLE_INLINE static Vector load(const float* from) { return _mm512_load_ps(from); }
  RUBBLE_INLINE static void store(float* to, Vector a) { _mm512_store_ps(to, a); }
  RUBBLE_INLINE static Mask is_larger(Vector a, Vector b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ);
  }
  RUBBLE_INLINE static Mask is_not_smaller(Vector a, Vector b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_GE_OQ);
  }
  RUBBLE_INLINE static Mask is_equal(Vector a, Vector b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ);
  }
  RUBBLE_INLINE static Vector select(Mask m, Vector a, Vector b) {
    return _mm512_mask_blend_ps(m, b, a);
  }
  RUBBLE_INLINE static Vector max(Vector a, Vector b) { return _mm512_max_ps(a, b); }
  RUBBLE_INLINE static Vector min(Vector a, Vector b) { return _mm512_min_ps(a, b); }
  RUBBLE_INLINE static Vector root(Vector a) { return _mm512_sqrt_ps(a); }
  RUBBLE_INLINE static bool any(Mask m) { return m != 0; }

  // Every fourth row, from row k on.
  template <typename Row>
  RUBBLE_INLINE static Vector join_rows(const Row& row, int k) {
    Vector v = _mm512_castps128_ps512(__m128(row(k)));
    v = _mm512_insertf32x4(v, __m128(row(k + 4)), 1);
    v = _mm512_insertf32x4(v, __m128(row(k + 8)), 2);
    return _mm512_insertf32x4(v, __m128(row(k + 12)), 3);
  }
  // transpose() in each quarter of four lanes.
  RUBBLE_INLINE static void transpose(Vector& a, Vector& b, Vector& c, Vector& d) {
    const Vector t0 = _mm512_unpacklo_ps(a, b), t1 = _mm512_unpacklo_ps(c, d);
    const Vector t2 = _mm512_unpackhi_ps(a, b), t3 = _mm512_unpackhi_ps(c, d);
    a = _mm512_shuffle_ps(t0, t1, 0x44), b = _mm512_shuffle_ps(t0, t1, 0xEE);
    c = _mm512_shuffle_ps(t2, t3, 0x44), d = _mm512_shuffle_ps(t2, t3, 0xEE);
  }
  // Eight numbers of two bodies, four lanes apart, from octet(k) and to write(k, octet).
  template <typename Octet>
  RUBBLE_INLINE static Vector join_octets(const Octet& octet, int k) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(octet(k)), octet(k + 4), 1);
  }
  template <typename Write>
  RUBBLE_INLINE static void split_octets(Vector a, int k, const Write& write) {
    write(k, _mm512_castps512_ps256(a));
    write(k + 4, _mm512_extractf32x8_ps(a, 1));
  }
  // The first and third quarters of both, or the second and fourth ones.
  RUBBLE_INLINE static Vector even_quarters(Vector a, Vector b) {
    return _mm512_shuffle_f32x4(a, b, 0x88);
  }
  RUBBLE_INLINE static Vector odd_quarters(Vector a, Vector b) {
    return _mm512_shuffle_f32x4(a, b, 0xDD);
  }
  // The way back: a quarter of the one and a quarter of the other in turn.
  RUBBLE_INLINE static Vector mix_low(Vector a, Vector b) {
    const __m512i from = _mm512_setr_epi32(0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
    return _mm512_permutex2var_ps(a, from, b);
  }
  RUBBLE_INLINE static Vector mix_high(Vector a, Vector b) {
    const __m512i from =
        _mm512_setr_epi32(8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31);
    return _mm512_permutex2var_ps(a, from, b);
  }
};

using SixteenLanes = WholeLanes<SixteenRegister>;

}  // namespace rubble
