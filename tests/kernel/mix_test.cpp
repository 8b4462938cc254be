// What a pile is drawn from, against what was asked for: Pearson's chi-square on fixed seeds.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/model/pile.h"
#include "kernel/model/size_distribution.h"
#include "kernel/settling/generator.h"

namespace rubble {
namespace mix_test {

double chi_square(const std::vector<int>& counts, const std::vector<double>& shares) {
  double total = 0, sum = 0;
  for (const int n : counts) total += n;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = total * shares[i];
    sum += (counts[i] - expected) * (counts[i] - expected) / expected;
  }
  return sum;
}

// Above this, one sample in a thousand of a right distribution falls; degrees of freedom: 1 to 9.
double limit(std::size_t bins) {
  static const double kLimits[] = {10.83, 13.82, 16.27, 18.47, 20.52, 22.46, 24.32, 26.12, 27.88};
  return kLimits[bins - 2];
}

PileSpec spec_of(std::vector<MixEntry> mix, std::uint64_t seed) {
  PileSpec spec;
  spec.seed = seed;
  spec.mix = std::move(mix);
  PieceType cube;
  cube.name = "cube";
  cube.parts.emplace_back();
  for (int i = 0; i < 8; ++i)
    cube.parts[0].points.push_back({i & 1 ? 0.05 : -0.05, i & 2 ? 0.05 : -0.05, i & 4 ? 0.05 : -0.05});
  spec.types.assign(spec.mix.size(), cube);
  spec.layers = 4;
  spec.pieces_per_layer = 1000;
  spec.spawn_bounds = {20, 20, 14};
  return spec;
}

std::vector<int> count_types(const Pile& pile) {
  std::vector<int> counts(pile.types.size(), 0);
  for (const Layer& layer : pile.layers)
    for (const Placement& piece : layer.pieces) ++counts[std::size_t(piece.kind.index)];
  return counts;
}

TEST(Mix, IsDrawnByItsWeights) {
  const std::vector<double> shares = {0.1, 0.45, 0.05, 0.4};
  std::vector<MixEntry> mix;
  for (int i = 0; i < 4; ++i) mix.push_back({i, 3 * shares[std::size_t(i)], 0.8, 1.2, {}});
  for (const std::uint64_t seed : {1, 2, 3}) {
    const std::vector<int> counts = count_types(generate_pile(spec_of(mix, seed)));
    EXPECT_LT(chi_square(counts, shares), limit(4)) << "seed " << seed;
    // The negative control: shares that are a little off are told apart.
    EXPECT_GT(chi_square(counts, {0.13, 0.42, 0.05, 0.4}), limit(4)) << "seed " << seed;
  }
}

// Shares of ten equal bins of [min, max], from the distribution's function.
template <typename Function>
std::vector<double> bins(double min, double max, Function distribution) {
  std::vector<double> shares;
  const double whole = distribution(max) - distribution(min);
  for (int i = 0; i < 10; ++i) {
    const double a = min + (max - min) * i / 10, b = min + (max - min) * (i + 1) / 10;
    shares.push_back((distribution(b) - distribution(a)) / whole);
  }
  return shares;
}

std::vector<int> count_sizes(const SizeDistribution& spread, double min, double max, std::uint64_t seed) {
  const Pile pile = generate_pile(spec_of({{0, 1, min, max, spread}}, seed));
  std::vector<int> counts(10, 0);
  for (const Layer& layer : pile.layers) {
    for (const Placement& piece : layer.pieces) {
      EXPECT_GE(piece.scale, min);
      EXPECT_LE(piece.scale, max);
      ++counts[std::size_t(std::min(9, int(10 * (piece.scale - min) / (max - min))))];
    }
  }
  return counts;
}

double normal_distribution(double x, double mean, double deviation) {
  return 0.5 * std::erfc((mean - x) / (deviation * std::sqrt(2.0)));
}

TEST(Mix, SizesFollowTheirSpread) {
  const double min = 0.5, max = 1.6;
  const auto uniform = bins(min, max, [](double x) { return x; });
  const auto normal = bins(min, max, [](double x) { return normal_distribution(x, 1, 0.3); });
  const auto lognormal =
      bins(min, max, [](double x) { return normal_distribution(std::log(x), std::log(0.9), 0.4); });
  for (const std::uint64_t seed : {4, 5}) {
    const auto u = count_sizes({}, min, max, seed);
    const auto n = count_sizes({Spread::normal, 1, 0.3}, min, max, seed);
    const auto l = count_sizes({Spread::lognormal, 0.9, 0.4}, min, max, seed);
    EXPECT_LT(chi_square(u, uniform), limit(10)) << "seed " << seed;
    EXPECT_LT(chi_square(n, normal), limit(10)) << "seed " << seed;
    EXPECT_LT(chi_square(l, lognormal), limit(10)) << "seed " << seed;
    // The negative control: each is told from the others.
    EXPECT_GT(chi_square(u, normal), limit(10));
    EXPECT_GT(chi_square(n, lognormal), limit(10));
    EXPECT_GT(chi_square(l, normal), limit(10));
  }
}

TEST(Mix, ARangeFarInATailIsStillDrawnFrom) {
  RandomStream random(1, "tail");
  const double size = draw_size({Spread::normal, 1, 0.01}, 2, 2.5, random);
  EXPECT_GE(size, 2);
  EXPECT_LE(size, 2.5);
}

}  // namespace mix_test
}  // namespace rubble
