#include "kernel/base/random.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

std::uint64_t split_mix(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

std::uint64_t rotate_left(std::uint64_t x, int bits) { return (x << bits) | (x >> (64 - bits)); }

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
  std::uint64_t mixer = seed ^ rotate_left(hash64(name), 17);
  for (std::uint64_t& word : state_) word = split_mix(mixer);
}

std::uint64_t RandomStream::next() {
  const std::uint64_t result = rotate_left(state_[1] * 5, 7) * 9;
  const std::uint64_t shifted = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= shifted;
  state_[3] = rotate_left(state_[3], 45);
  return result;
}

double RandomStream::uniform() { return double(next() >> 11) * 0x1p-53; }
double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::uint64_t RandomStream::below(std::uint64_t count) {
  const std::uint64_t rejected = (0 - count) % count;  // 2^64 mod count
  for (;;) {
    __extension__ using Wide = unsigned __int128;
    const Wide product = Wide(next()) * count;
    if (std::uint64_t(product) >= rejected) return std::uint64_t(product >> 64);
  }
}

double RandomStream::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += uniform();
  return sum;
}

Vec3 RandomStream::direction() {
  for (;;) {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    const double s = x * x + y * y + z * z;
    if (s > 1e-6 && s <= 1.0) return Vec3{x, y, z} * (1.0 / std::sqrt(s));
  }
}

Quat RandomStream::rotation() {
  for (;;) {
    const double w = uniform(-1, 1), x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    const double s = w * w + x * x + y * y + z * z;
    if (s > 1e-6 && s <= 1.0) return normalized(Quat{w, x, y, z});
  }
}

WeightedChoice::WeightedChoice(const std::vector<double>& weights) {
  double sum = 0;
  for (const double w : weights) {
    if (!(w >= 0.0) || !(w < 1e300))
      throw std::invalid_argument("a weight is negative or not finite: " + brief_text(w));
    cumulative_.push_back(sum += w);
  }
  if (!(sum > 0.0)) throw std::invalid_argument("no weight is above zero");
}

int WeightedChoice::draw(RandomStream& random) const {
  const double u = random.uniform() * cumulative_.back();
  const auto it = std::upper_bound(cumulative_.begin(), cumulative_.end(), u);
  return int(std::min<std::ptrdiff_t>(it - cumulative_.begin(),
                                      std::ptrdiff_t(cumulative_.size()) - 1));
}

}  // namespace rubble
