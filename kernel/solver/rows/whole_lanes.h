// Packets that are one register. Register: eight_lanes.h, sixteen_lanes.h. For these alone.
#pragma once

#include "kernel/solver/rows/packets.h"

namespace rubble {

template <typename Register>
struct WholeLanes {
  static constexpr int width() { return Register::width(); }
  using Vector = typename Register::Vector;
  struct Mask {
    typename Register::Mask m;
  };
  Vector v;

  WholeLanes() = default;
  RUBBLE_INLINE WholeLanes(Vector vector) : v(vector) {}
  RUBBLE_INLINE explicit WholeLanes(float x) : v(Register::all(x)) {}
  // The lanes from `first` on.
  RUBBLE_INLINE WholeLanes(const Lanes& l, int first) : v(Register::load(l.lane + first)) {}
  RUBBLE_INLINE void store(Lanes& to, int first) const { Register::store(to.lane + first, v); }
  // Rows to columns: element k of the rows of four that row(i) returns is packet k.
  template <typename Row>
  RUBBLE_INLINE static Columns<WholeLanes> gather(const Row& row) {
    Vector x = Register::join_rows(row, 0), y = Register::join_rows(row, 1);
    Vector z = Register::join_rows(row, 2), w = Register::join_rows(row, 3);
    Register::transpose(x, y, z, w);
    return {{x}, {y}, {z}, {w}};
  }

#define RUBBLE_WHOLE(op)                                                                  \
  RUBBLE_INLINE friend WholeLanes operator op(const WholeLanes& a, const WholeLanes& b) { \
    return {a.v op b.v};                                                                  \
  }
  RUBBLE_WHOLE(+)
  RUBBLE_WHOLE(-)
  RUBBLE_WHOLE(*)
  RUBBLE_WHOLE(/)
#undef RUBBLE_WHOLE
  RUBBLE_INLINE friend WholeLanes operator-(const WholeLanes& a) { return {-a.v}; }
  RUBBLE_INLINE friend Mask operator>(const WholeLanes& a, const WholeLanes& b) {
    return {Register::is_larger(a.v, b.v)};
  }
  RUBBLE_INLINE friend Mask operator>=(const WholeLanes& a, const WholeLanes& b) {
    return {Register::is_not_smaller(a.v, b.v)};
  }
  RUBBLE_INLINE friend Mask operator==(const WholeLanes& a, const WholeLanes& b) {
    return {Register::is_equal(a.v, b.v)};
  }
  RUBBLE_INLINE friend WholeLanes select(Mask m, const WholeLanes& a, const WholeLanes& b) {
    return {Register::select(m.m, a.v, b.v)};
  }
  RUBBLE_INLINE friend WholeLanes max(const WholeLanes& a, const WholeLanes& b) {
    return {Register::max(a.v, b.v)};
  }
  RUBBLE_INLINE friend WholeLanes min(const WholeLanes& a, const WholeLanes& b) {
    return {Register::min(a.v, b.v)};
  }
  RUBBLE_INLINE friend WholeLanes sqrt(const WholeLanes& a) { return {Register::root(a.v)}; }
  RUBBLE_INLINE friend bool any(Mask m) { return Register::any(m.m); }
};

}  // namespace rubble
