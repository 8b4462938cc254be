// The motions of the bodies of a packet, in and out of memory: a body's six numbers lie together, and the
// loops want each number of all bodies together. For contact_rows.cpp alone.
#pragma once

#include "kernel/solver/contact_rows.h"
#include "kernel/solver/rows/packets.h"

namespace rubble {

// Lane by lane.
template <typename P>
struct Motions {
  Packet3<P> linear, angular;
};

// index: of the bodies of the lanes.
RUBBLE_INLINE void load(const PaddedMotion* v, const std::int32_t* index, Motions<TwoHalves>& m) {
  const auto l = TwoHalves::gather(
      [&](int i) __attribute__((always_inline)) { return v[index[i]].linear; });
  const auto a = TwoHalves::gather(
      [&](int i) __attribute__((always_inline)) { return v[index[i]].angular; });
  m = {{l.x, l.y, l.z}, {a.x, a.y, a.z}};
}

RUBBLE_INLINE void save(const Motions<TwoHalves>& m, PaddedMotion* v, const std::int32_t* index) {
  TwoHalves::scatter(
      m.linear.x, m.linear.y, m.linear.z,
      [&](int i, Quad row) __attribute__((always_inline)) { v[index[i]].linear = row; });
  TwoHalves::scatter(
      m.angular.x, m.angular.y, m.angular.z,
      [&](int i, Quad row) __attribute__((always_inline)) { v[index[i]].angular = row; });
}

}  // namespace rubble
