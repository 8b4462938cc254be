// Random numbers by place instead of in order: the noise of a pixel is the same whichever thread
// works it out, and however many pixels are looked at.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "kernel/base/random.h"

namespace rubble {

// Of many places at once: the same bits as one by one, several to a register.
struct NoiseLanes {
  const char* name;  // of the instruction set
  void (*normal)(std::uint64_t key, const std::uint32_t* places, std::size_t count, double* out);
  void (*poisson)(std::uint64_t key, const std::uint32_t* places, const double* means, std::size_t count, double* out);
};
// Those that this processor can run, the fastest first. Never empty.
const std::vector<NoiseLanes>& noise_lanes();

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
  // out: one each
  void normal(const std::uint32_t* places, std::size_t count, double* out, const NoiseLanes& lanes = noise_lanes().front()) const {
    lanes.normal(key_, places, count, out);
  }
  void poisson(const std::uint32_t* places, const double* means, std::size_t count, double* out,
               const NoiseLanes& lanes = noise_lanes().front()) const {
    lanes.poisson(key_, places, means, count, out);
  }

  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  // The finaliser of SplitMix64 (Steele, Lea and Flood 2014), of one number or of lanes.
  template <typename Word>
  [[gnu::always_inline]] static Word mix(Word x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }

 private:
  std::uint64_t bits(std::uint64_t place) const { return mix(key_ + place * kStep); }

  std::uint64_t key_;
};

}  // namespace rubble
