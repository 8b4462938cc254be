// Two ways to compute with eight lanes.
//
// EightLanes is one register of AVX, for functions that are compiled for AVX2 and called where the
// processor has it; TwoHalves is two registers of any machine. Each lane is computed by the plain IEEE
// operations in the order written, so both give the same bits. Everything is inlined: there is no
// calling convention to differ. For contact_rows.cpp alone.
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
struct EightRows {
  Quad r0, r1, r2, r3, r4, r5, r6, r7;
};

struct TwoHalves {
  struct Mask {
    QuadMask low, high;
  };
  Quad low{}, high{};

  TwoHalves() = default;
  RUBBLE_INLINE TwoHalves(Quad l, Quad h) : low(l), high(h) {}
  RUBBLE_INLINE explicit TwoHalves(float x) : low(make_quad(x)), high(make_quad(x)) {}
  RUBBLE_INLINE explicit TwoHalves(const Lanes& l)
      : low(load_quad(l.lane)), high(load_quad(l.lane + 4)) {}
  RUBBLE_INLINE void store(Lanes& to) const { std::memcpy(to.lane, this, sizeof to.lane); }
  // Rows to columns: element k of eight rows of four is packet k.
  RUBBLE_INLINE static Columns<TwoHalves> gather(Quad r0, Quad r1, Quad r2, Quad r3, Quad r4,
                                                 Quad r5, Quad r6, Quad r7) {
    transpose(r0, r1, r2, r3);
    transpose(r4, r5, r6, r7);
    return {{r0, r4}, {r1, r5}, {r2, r6}, {r3, r7}};
  }
  // Columns to rows; the fourth element of each row is zero.
  RUBBLE_INLINE static EightRows scatter(const TwoHalves& x, const TwoHalves& y,
                                         const TwoHalves& z) {
    EightRows r{x.low, y.low, z.low, Quad{}, x.high, y.high, z.high, Quad{}};
    transpose(r.r0, r.r1, r.r2, r.r3);
    transpose(r.r4, r.r5, r.r6, r.r7);
    return r;
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

#if defined(__x86_64__)
struct EightLanes {
  typedef float Vector __attribute__((vector_size(32)));
  typedef float InMemory __attribute__((vector_size(32), may_alias));
  typedef int VectorMask __attribute__((vector_size(32)));
  struct Mask {
    VectorMask v;
  };
  Vector v{};

  EightLanes() = default;
  RUBBLE_INLINE EightLanes(Vector vector) : v(vector) {}
  // Copies of the vector: one of the struct goes in two pieces, and waits for them when it is read.
  RUBBLE_INLINE EightLanes(const EightLanes& other) : v(other.v) {}
  RUBBLE_INLINE EightLanes& operator=(const EightLanes& other) { return v = other.v, *this; }
  RUBBLE_INLINE explicit EightLanes(float x) : v(Vector{x, x, x, x, x, x, x, x}) {}
  RUBBLE_INLINE explicit EightLanes(const Lanes& l)
      : v(*reinterpret_cast<const InMemory*>(l.lane)) {}
  RUBBLE_INLINE void store(Lanes& to) const { *reinterpret_cast<InMemory*>(to.lane) = v; }
  RUBBLE_INLINE static Vector join(Quad a, Quad b) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  RUBBLE_INLINE static Quad low(Vector a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }
  RUBBLE_INLINE static Quad high(Vector a) { return __builtin_shufflevector(a, a, 4, 5, 6, 7); }
  // transpose() in both halves at once.
  RUBBLE_INLINE static void transpose(Vector& a, Vector& b, Vector& c, Vector& d) {
    const Vector t0 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const Vector t1 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const Vector t2 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const Vector t3 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    a = __builtin_shufflevector(t0, t1, 0, 1, 8, 9, 4, 5, 12, 13);
    b = __builtin_shufflevector(t0, t1, 2, 3, 10, 11, 6, 7, 14, 15);
    c = __builtin_shufflevector(t2, t3, 0, 1, 8, 9, 4, 5, 12, 13);
    d = __builtin_shufflevector(t2, t3, 2, 3, 10, 11, 6, 7, 14, 15);
  }
  RUBBLE_INLINE static Columns<EightLanes> gather(Quad r0, Quad r1, Quad r2, Quad r3, Quad r4,
                                                  Quad r5, Quad r6, Quad r7) {
    Vector x = join(r0, r4), y = join(r1, r5), z = join(r2, r6), w = join(r3, r7);
    transpose(x, y, z, w);
    return {{x}, {y}, {z}, {w}};
  }
  RUBBLE_INLINE static EightRows scatter(const EightLanes& x, const EightLanes& y,
                                         const EightLanes& z) {
    Vector a = x.v, b = y.v, c = z.v, d{};
    transpose(a, b, c, d);
    return {low(a), low(b), low(c), low(d), high(a), high(b), high(c), high(d)};
  }
};
#define RUBBLE_EIGHT(op)                                                          \
  RUBBLE_INLINE EightLanes operator op(const EightLanes& a, const EightLanes& b) { \
    return {a.v op b.v};                                                          \
  }
RUBBLE_EIGHT(+)
RUBBLE_EIGHT(-)
RUBBLE_EIGHT(*)
RUBBLE_EIGHT(/)
#undef RUBBLE_EIGHT
RUBBLE_INLINE EightLanes operator-(const EightLanes& a) { return {-a.v}; }
RUBBLE_INLINE EightLanes::Mask operator>(const EightLanes& a, const EightLanes& b) {
  return {a.v > b.v};
}
RUBBLE_INLINE EightLanes::Mask operator>=(const EightLanes& a, const EightLanes& b) {
  return {a.v >= b.v};
}
RUBBLE_INLINE EightLanes::Mask operator==(const EightLanes& a, const EightLanes& b) {
  return {a.v == b.v};
}
RUBBLE_INLINE EightLanes select(EightLanes::Mask m, const EightLanes& a, const EightLanes& b) {
  return {m.v ? a.v : b.v};
}
RUBBLE_INLINE bool any(EightLanes::Mask m) {
  const QuadMask both = __builtin_shufflevector(m.v, m.v, 0, 1, 2, 3) |
                        __builtin_shufflevector(m.v, m.v, 4, 5, 6, 7);
  return (both[0] | both[1] | both[2] | both[3]) != 0;
}
RUBBLE_INLINE EightLanes sqrt(const EightLanes& a) {
  return {EightLanes::join(sqrt(EightLanes::low(a.v)), sqrt(EightLanes::high(a.v)))};
}
#endif

template <typename P>
RUBBLE_INLINE P max(const P& a, const P& b) {
  return select(a > b, a, b);
}

// Three packets.
template <typename P>
struct Packet3 {
  P x, y, z;

  Packet3() = default;
  RUBBLE_INLINE Packet3(const P& x_, const P& y_, const P& z_) : x(x_), y(y_), z(z_) {}
  RUBBLE_INLINE explicit Packet3(const Lanes3& l) : x(l.x), y(l.y), z(l.z) {}
  RUBBLE_INLINE void store(Lanes3& to) const { x.store(to.x), y.store(to.y), z.store(to.z); }
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
