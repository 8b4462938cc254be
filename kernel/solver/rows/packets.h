// Three ways to compute with the lanes of a batch.
//
// TwoHalves is two registers of any machine. EightLanes is one register of AVX2 (eight_lanes.h) and
// SixteenLanes one of AVX-512 (sixteen_lanes.h), for functions that are compiled for these and called where
// the processor has them. A batch takes one packet of SixteenLanes, or two of the others one after the other:
// no two contacts of a batch share a moving body. Each lane is computed by the plain IEEE operations in the
// order written, so all give the same bits. Everything is inlined: there is no calling convention to differ.
// For contact_rows*.cpp alone.
#pragma once

#include <cmath>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include "kernel/solver/wide.h"

namespace rubble {

// Rows to columns: element i of the k-th result is element k of the i-th argument.
RUBBLE_INLINE void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad t0 = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Quad t1 = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Quad t2 = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Quad t3 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(t0, t1, 0, 1, 4, 5);
  b = __builtin_shufflevector(t0, t1, 2, 3, 6, 7);
  c = __builtin_shufflevector(t2, t3, 0, 1, 4, 5);
  d = __builtin_shufflevector(t2, t3, 2, 3, 6, 7);
}

template <typename P>
struct Columns {
  P x, y, z, w;
};

struct TwoHalves {
  static constexpr int width() { return 8; }
  struct Mask {
    QuadMask low, high;
  };
  Quad low, high;

  TwoHalves() = default;
  RUBBLE_INLINE TwoHalves(Quad l, Quad h) : low(l), high(h) {}
  RUBBLE_INLINE explicit TwoHalves(float x) : low(make_quad(x)), high(make_quad(x)) {}
  // The lanes from `first` on.
  RUBBLE_INLINE TwoHalves(const Lanes& l, int first)
      : low(load_quad(l.lane + first)), high(load_quad(l.lane + first + 4)) {}
  RUBBLE_INLINE void store(Lanes& to, int first) const {
    std::memcpy(to.lane + first, this, sizeof *this);
  }
  // Rows to columns: element k of the rows of four that row(i) returns is packet k.
  template <typename Row>
  RUBBLE_INLINE static Columns<TwoHalves> gather(const Row& row) {
    Quad r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
    Quad r4 = row(4), r5 = row(5), r6 = row(6), r7 = row(7);
    transpose(r0, r1, r2, r3);
    transpose(r4, r5, r6, r7);
    return {{r0, r4}, {r1, r5}, {r2, r6}, {r3, r7}};
  }
  // Columns to rows, for write(i, row); the fourth element of each row is zero.
  template <typename Write>
  RUBBLE_INLINE static void scatter(const TwoHalves& x, const TwoHalves& y, const TwoHalves& z,
                                    const Write& write) {
    Quad r0 = x.low, r1 = y.low, r2 = z.low, r3{};
    Quad r4 = x.high, r5 = y.high, r6 = z.high, r7{};
    transpose(r0, r1, r2, r3);
    transpose(r4, r5, r6, r7);
    write(0, r0), write(1, r1), write(2, r2), write(3, r3);
    write(4, r4), write(5, r5), write(6, r6), write(7, r7);
  }
};

#define RUBBLE_HALVES(op)                                                       \
  RUBBLE_INLINE TwoHalves operator op(const TwoHalves& a, const TwoHalves& b) { \
    return {a.low op b.low, a.high op b.high};                                  \
  }
RUBBLE_HALVES(+)
RUBBLE_HALVES(-)
RUBBLE_HALVES(*)
RUBBLE_HALVES(/)
#undef RUBBLE_HALVES
RUBBLE_INLINE TwoHalves operator-(const TwoHalves& a) { return {-a.low, -a.high}; }
RUBBLE_INLINE TwoHalves::Mask operator>(const TwoHalves& a, const TwoHalves& b) {
  return {a.low > b.low, a.high > b.high};
}
RUBBLE_INLINE TwoHalves::Mask operator>=(const TwoHalves& a, const TwoHalves& b) {
  return {a.low >= b.low, a.high >= b.high};
}
RUBBLE_INLINE TwoHalves::Mask operator==(const TwoHalves& a, const TwoHalves& b) {
  return {a.low == b.low, a.high == b.high};
}
RUBBLE_INLINE TwoHalves select(TwoHalves::Mask m, const TwoHalves& a, const TwoHalves& b) {
  return {m.low ? a.low : b.low, m.high ? a.high : b.high};
}
RUBBLE_INLINE TwoHalves max(const TwoHalves& a, const TwoHalves& b) { return select(a > b, a, b); }
RUBBLE_INLINE TwoHalves min(const TwoHalves& a, const TwoHalves& b) { return select(b > a, a, b); }
RUBBLE_INLINE bool any(TwoHalves::Mask m) {
  const QuadMask both = m.low | m.high;
  return (both[0] | both[1] | both[2] | both[3]) != 0;
}
// Correctly rounded by every one of these.
RUBBLE_INLINE Quad sqrt(Quad a) {
#if defined(__x86_64__)
  return Quad(_mm_sqrt_ps(__m128(a)));
#else
  return Quad{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}
RUBBLE_INLINE TwoHalves sqrt(const TwoHalves& a) {
  return {sqrt(a.low), sqrt(a.high)};
}

// Three packets.
template <typename P>
struct Packet3 {
  P x, y, z;

  Packet3() = default;
  RUBBLE_INLINE Packet3(const P& x_, const P& y_, const P& z_) : x(x_), y(y_), z(z_) {}
  RUBBLE_INLINE Packet3(const Lanes3& l, int first) : x(l.x, first), y(l.y, first), z(l.z, first) {}
  RUBBLE_INLINE void store(Lanes3& to, int first) const {
    x.store(to.x, first), y.store(to.y, first), z.store(to.z, first);
  }
  RUBBLE_INLINE Packet3& operator+=(const Packet3& v) {
    return x = x + v.x, y = y + v.y, z = z + v.z, *this;
  }
  RUBBLE_INLINE Packet3& operator-=(const Packet3& v) {
    return x = x - v.x, y = y - v.y, z = z - v.z, *this;
  }
};
template <typename P>
RUBBLE_INLINE Packet3<P> operator+(const Packet3<P>& a, const Packet3<P>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename P>
RUBBLE_INLINE Packet3<P> operator-(const Packet3<P>& a, const Packet3<P>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename P>
RUBBLE_INLINE Packet3<P> operator*(const Packet3<P>& a, const P& s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <typename P>
RUBBLE_INLINE P dot(const Packet3<P>& a, const Packet3<P>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename P>
RUBBLE_INLINE Packet3<P> cross(const Packet3<P>& a, const Packet3<P>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace rubble
