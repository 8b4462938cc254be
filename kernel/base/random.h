// Seeded randomness with named streams: one seed, and a name for each use, so that drawing more
// for one purpose never changes another. The standard library's distributions differ between
// implementations; these do not. Nothing here touches libm.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// xoshiro256** (Blackman and Vigna 2018), seeded through SplitMix64 from (seed, name).
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  std::uint64_t next();                      // all 64 bits
  double uniform();                          // [0, 1), 53 bits
  double uniform(double low, double high);   // [low, high)
  std::uint64_t below(std::uint64_t count);  // 0 .. count-1 without bias (Lemire 2019); count > 0
  // Standard normal by the sum of twelve uniforms, less 6 (tails end at 6 sigma).
  double normal();
  Vec3 direction();  // uniform on the unit sphere, by rejection
  Quat rotation();   // uniform on SO(3), by rejection in the 4-ball

 private:
  std::uint64_t state_[4];
};

// Draws an index with probability weight / sum of weights.
class WeightedChoice {
 public:
  // weights: finite, >= 0, at least one > 0; throws std::invalid_argument otherwise.
  explicit WeightedChoice(const std::vector<double>& weights);
  int draw(RandomStream& random) const;

 private:
  std::vector<double> cumulative_;
};

}  // namespace rubble
