// Random numbers by place instead of in order: the noise of a pixel is the same whichever thread
// works it out, and however many pixels are looked at.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "kernel/base/random.h"

namespace rubble {

class NoiseField {
 public:
  // Fields of different names or numbers have nothing in common.
  NoiseField(std::uint64_t seed, std::string_view name, std::uint64_t number = 0)
      : key_(mix(RandomStream(seed, name).next() + number * kStep)) {}

  double uniform(std::uint64_t place) const {  // [0, 1)
    return double(bits(place) >> 11) * 0x1p-53;
  }
  double normal(std::uint64_t place) const {  // Box and Muller (1958)
    const double u = double((bits(2 * place) >> 11) + 1) * 0x1p-53, v = uniform(2 * place + 1);
    return std::sqrt(-2 * quick::log(u)) * quick::cos(2 * portable::kPi * v);
  }
  // Poisson: by inversion up to a mean of 30, beyond by the normal with its skew put right
  // (Cornish and Fisher 1937).
  double poisson(std::uint64_t place, double mean) const {
    if (!(mean > 0)) return 0;
    if (mean > 30) {
      const double z = normal(place);
      const double value = mean + std::sqrt(mean) * z + (z * z - 1) / 6;
      return value > 0 ? std::floor(value + 0.5) : 0;
    }
    double p = quick::exp(-mean), left = uniform(2 * place) - p, count = 0;
    while (left >= 0 && count < 200) p *= mean / ++count, left -= p;
    return count;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  // The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
  std::uint64_t bits(std::uint64_t place) const { return mix(key_ + place * kStep); }

  std::uint64_t key_;
};

}  // namespace rubble
