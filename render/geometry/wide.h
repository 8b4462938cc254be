// Numbers for several pixels or triangles at a time: one lane each, in a register of the instruction set that
// this is compiled for. Only plain IEEE operations, in the order written: every width gives the
// same bits.
//
// The sources that include it are compiled once for each instruction set
// (CMakeLists.txt), in a namespace of its name (RUBBLE_ISA), so that no inline function of one can
// end up in another.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#define RUBBLE_INLINE [[gnu::always_inline]] inline
#define RUBBLE_TEXT_OF(name) #name
#define RUBBLE_NAME_OF(name) RUBBLE_TEXT_OF(name)
#define RUBBLE_NAME_OF_ISA RUBBLE_NAME_OF(RUBBLE_ISA)  // a literal

namespace rubble::RUBBLE_ISA {

#if defined(__AVX512F__)
inline constexpr int kWidth = 16;
#elif defined(__AVX2__)
inline constexpr int kWidth = 8;
#else
inline constexpr int kWidth = 4;
#endif

typedef float Real __attribute__((vector_size(kWidth * 4)));
typedef std::int32_t Int __attribute__((vector_size(kWidth * 4)));
typedef std::uint32_t Word __attribute__((vector_size(kWidth * 4)));
typedef Int Mask;  // of a lane all bits or none

RUBBLE_INLINE Real real(float x) { return x - Real{}; }
RUBBLE_INLINE Int integer(int x) { return x - Int{}; }
RUBBLE_INLINE Word word(std::uint32_t x) { return x - Word{}; }
RUBBLE_INLINE Mask mask(bool b) { return integer(b ? -1 : 0); }
RUBBLE_INLINE Real as_real(Word w) { return Real(w); }
RUBBLE_INLINE Real real_from_bits(Int i) { return Real(i); }
RUBBLE_INLINE Int bits_of(Real x) { return Int(x); }
RUBBLE_INLINE Mask both(Mask a, Mask b) { return a & b; }
RUBBLE_INLINE Mask either(Mask a, Mask b) { return a | b; }

RUBBLE_INLINE Real to_real(Int i) { return __builtin_convertvector(i, Real); }
// Towards zero; of what an Int holds.
RUBBLE_INLINE Int to_int(Real x) { return __builtin_convertvector(x, Int); }

RUBBLE_INLINE bool any(Mask m) {
#if defined(__AVX512F__)
  return _mm512_test_epi32_mask(__m512i(m), __m512i(m)) != 0;
#elif defined(__AVX2__)
  return _mm256_movemask_ps(__m256(m)) != 0;
#elif defined(__x86_64__)
  return _mm_movemask_ps(__m128(m)) != 0;
#else
  int all = 0;
  for (int i = 0; i < kWidth; ++i) all |= m[i];
  return all != 0;
#endif
}

RUBBLE_INLINE Real select(Mask m, Real a, Real b) { return m ? a : b; }
RUBBLE_INLINE Int select(Mask m, Int a, Int b) { return m ? a : b; }
RUBBLE_INLINE Real min(Real a, Real b) { return a < b ? a : b; }
RUBBLE_INLINE Real max(Real a, Real b) { return a > b ? a : b; }
RUBBLE_INLINE Real min(Real a, float b) { return min(a, real(b)); }
RUBBLE_INLINE Real max(Real a, float b) { return max(a, real(b)); }
RUBBLE_INLINE Int min(Int a, Int b) { return a < b ? a : b; }
RUBBLE_INLINE Int max(Int a, Int b) { return a > b ? a : b; }
RUBBLE_INLINE Int clamp(Int x, int low, int high) {
  return min(max(x, integer(low)), integer(high));
}
RUBBLE_INLINE Real clamp(Real x, float low, float high) { return min(max(x, low), high); }
RUBBLE_INLINE Real abs(Real x) { return Real(Int(x) & 0x7fffffff); }

RUBBLE_INLINE Real sqrt(Real x) {
#if defined(__AVX512F__)
  return Real(_mm512_sqrt_ps(__m512(x)));
#elif defined(__AVX2__)
  return Real(_mm256_sqrt_ps(__m256(x)));
#elif defined(__x86_64__)
  return Real(_mm_sqrt_ps(__m128(x)));
#else
  Real out;
  for (int i = 0; i < kWidth; ++i) out[i] = std::sqrt(x[i]);
  return out;
#endif
}

RUBBLE_INLINE Real floor(Real x) {
#if defined(__AVX512F__)
  return Real(_mm512_roundscale_ps(__m512(x), 0x09));
#elif defined(__AVX2__)
  return Real(_mm256_floor_ps(__m256(x)));
#else
  const Real whole = to_real(to_int(x)), below = select(whole > x, whole - 1.0f, whole);
  return select(abs(x) < 8388608.0f, below, x);  // larger ones are whole
#endif
}

// base[i] in each lane.
RUBBLE_INLINE Real gather(const float* base, Int i) {
#if defined(__AVX512F__)
  return Real(_mm512_i32gather_ps(__m512i(i), base, 4));
#elif defined(__AVX2__)
  return Real(_mm256_i32gather_ps(base, __m256i(i), 4));
#else
  Real out;
  for (int k = 0; k < kWidth; ++k) out[k] = base[i[k]];
  return out;
#endif
}
RUBBLE_INLINE Word gather(const std::uint32_t* base, Int i) {
#if defined(__AVX512F__)
  return Word(_mm512_i32gather_epi32(__m512i(i), base, 4));
#elif defined(__AVX2__)
  return Word(_mm256_i32gather_epi32(reinterpret_cast<const int*>(base), __m256i(i), 4));
#else
  Word out;
  for (int k = 0; k < kWidth; ++k) out[k] = base[i[k]];
  return out;
#endif
}

// Of a table whose rows have four words: the row of each lane, by columns.
struct Row {
  Word x, y, z, w;  // columns
};

RUBBLE_INLINE Row load_rows(const void* table, Int row) {
  const auto* base = static_cast<const char*>(table);
#if defined(__x86_64__)
  const auto one = [&](int lane) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(base + std::ptrdiff_t(row[lane]) * 16));
  };
#endif
#if defined(__AVX512F__)
  const auto four = [&](int k) {
    __m512i v = _mm512_castsi128_si512(one(k));
    v = _mm512_inserti32x4(v, one(k + 4), 1);
    v = _mm512_inserti32x4(v, one(k + 8), 2);
    return _mm512_inserti32x4(v, one(k + 12), 3);
  };
  const __m512i a = four(0), b = four(1), c = four(2), d = four(3);
  const __m512i p = _mm512_unpacklo_epi32(a, b), q = _mm512_unpackhi_epi32(a, b);
  const __m512i r = _mm512_unpacklo_epi32(c, d), s = _mm512_unpackhi_epi32(c, d);
  return {Word(_mm512_unpacklo_epi64(p, r)), Word(_mm512_unpackhi_epi64(p, r)),
          Word(_mm512_unpacklo_epi64(q, s)), Word(_mm512_unpackhi_epi64(q, s))};
#elif defined(__AVX2__)
  const auto two = [&](int k) {
    return _mm256_inserti128_si256(_mm256_castsi128_si256(one(k)), one(k + 4), 1);
  };
  const __m256i a = two(0), b = two(1), c = two(2), d = two(3);
  const __m256i p = _mm256_unpacklo_epi32(a, b), q = _mm256_unpackhi_epi32(a, b);
  const __m256i r = _mm256_unpacklo_epi32(c, d), s = _mm256_unpackhi_epi32(c, d);
  return {Word(_mm256_unpacklo_epi64(p, r)), Word(_mm256_unpackhi_epi64(p, r)),
          Word(_mm256_unpacklo_epi64(q, s)), Word(_mm256_unpackhi_epi64(q, s))};
#elif defined(__x86_64__)
  const __m128i a = one(0), b = one(1), c = one(2), d = one(3);
  const __m128i p = _mm_unpacklo_epi32(a, b), q = _mm_unpackhi_epi32(a, b);
  const __m128i r = _mm_unpacklo_epi32(c, d), s = _mm_unpackhi_epi32(c, d);
  return {Word(_mm_unpacklo_epi64(p, r)), Word(_mm_unpackhi_epi64(p, r)),
          Word(_mm_unpacklo_epi64(q, s)), Word(_mm_unpackhi_epi64(q, s))};
#else
  Row out;
  for (int k = 0; k < kWidth; ++k) {
    std::uint32_t words[4];
    std::memcpy(words, base + std::ptrdiff_t(row[k]) * 16, 16);
    out.x[k] = words[0], out.y[k] = words[1], out.z[k] = words[2], out.w[k] = words[3];
  }
  return out;
#endif
}

}  // namespace rubble::RUBBLE_ISA
