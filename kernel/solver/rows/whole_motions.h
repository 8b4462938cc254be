// The motions of the bodies of a packet that is one register, in and out of memory. To be included where
// whole_lanes.h is.
#pragma once

#include <immintrin.h>

#include "kernel/solver/rows/motion_lanes.h"
#include "kernel/solver/rows/whole_lanes.h"

namespace rubble {

// A whole body goes in and out at once: a register holds one of them, or that of four lanes later too. So
// four registers have the bodies of four lanes in turn, linear parts and angular ones in quarters of their own.
template <typename Register>
RUBBLE_INLINE void load(const PaddedMotion* v, const std::int32_t* index,
                        Motions<WholeLanes<Register>>& m) {
  using Vector = typename Register::Vector;
  constexpr int kHalf = Register::width() / 2;
  const auto body = [&](int i) __attribute__((always_inline)) {
    return _mm256_load_ps(reinterpret_cast<const float*>(&v[index[i]]));
  };
  const auto four = [&](int i, Packet3<WholeLanes<Register>>& to) __attribute__((always_inline)) {
    Vector x = Register::join_octets(body, i), y = Register::join_octets(body, i + 1);
    Vector z = Register::join_octets(body, i + 2), w = Register::join_octets(body, i + 3);
    Register::transpose(x, y, z, w);
    to = {{x}, {y}, {z}};
  };
  Packet3<WholeLanes<Register>> low, high;
  four(0, low), four(kHalf, high);
  m.linear = {{Register::even_quarters(low.x.v, high.x.v)},
              {Register::even_quarters(low.y.v, high.y.v)},
              {Register::even_quarters(low.z.v, high.z.v)}};
  m.angular = {{Register::odd_quarters(low.x.v, high.x.v)},
               {Register::odd_quarters(low.y.v, high.y.v)},
               {Register::odd_quarters(low.z.v, high.z.v)}};
}

template <typename Register>
RUBBLE_INLINE void save(const Motions<WholeLanes<Register>>& m, PaddedMotion* v,
                        const std::int32_t* index) {
  using Vector = typename Register::Vector;
  constexpr int kHalf = Register::width() / 2;
  const auto write = [&](int i, __m256 body) __attribute__((always_inline)) {
    _mm256_store_ps(reinterpret_cast<float*>(&v[index[i]]), body);
  };
  const auto four = [&](Vector x, Vector y, Vector z, int i) __attribute__((always_inline)) {
    Vector w{};
    Register::transpose(x, y, z, w);
    Register::split_octets(x, i, write), Register::split_octets(y, i + 1, write);
    Register::split_octets(z, i + 2, write), Register::split_octets(w, i + 3, write);
  };
  const Packet3<WholeLanes<Register>>&l = m.linear, &a = m.angular;
  four(Register::mix_low(l.x.v, a.x.v), Register::mix_low(l.y.v, a.y.v), Register::mix_low(l.z.v, a.z.v), 0);
  four(Register::mix_high(l.x.v, a.x.v), Register::mix_high(l.y.v, a.y.v), Register::mix_high(l.z.v, a.z.v),
       kHalf);
}

}  // namespace rubble
