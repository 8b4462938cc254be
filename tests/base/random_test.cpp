#include "kernel/base/random.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace rubble {
namespace random_test {

TEST(RandomStream, IsTheSameForTheSameSeedAndName) {
  RandomStream a(42, "pile"), b(42, "pile"), other_name(42, "light"), other_seed(43, "pile");
  const std::uint64_t first = a.next();
  EXPECT_EQ(first, b.next());
  EXPECT_NE(first, other_name.next());
  EXPECT_NE(first, other_seed.next());
}

// The sequence is part of what a seed promises: a change here changes every pile.
TEST(RandomStream, KeepsItsSequence) {
  RandomStream random(1, "golden");
  const std::uint64_t a = random.next(), b = random.next();
  EXPECT_EQ(a, 0x9a0559dc9299f34eu) << std::hex << a;
  EXPECT_EQ(b, 0x998f6ac27a3d4a20u) << std::hex << b;
}

TEST(RandomStream, UniformHasTheRightMoments) {
  RandomStream random(7, "moments");
  double sum = 0, squares = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 0.004);
  EXPECT_NEAR(squares / n, 1.0 / 3.0, 0.004);
}

TEST(RandomStream, RotationsHaveNoPreferredDirection) {
  RandomStream random(7, "rotations");
  Vec3 mean;
  for (int i = 0; i < 20000; ++i) mean += random.rotation().rotate({0, 0, 1});
  EXPECT_LT(norm(mean * (1.0 / 20000)), 0.02);
}

// 99.9 % of chi-square values with 5 degrees of freedom lie below 20.5.
TEST(WeightedChoice, IsUnbiasedByChiSquare) {
  const std::vector<double> weights{0.55, 0.15, 0.0, 0.15, 0.10, 0.05, 0.30};
  const WeightedChoice choice(weights);
  RandomStream random(11, "chi-square");
  std::vector<int> counts(weights.size());
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) ++counts[std::size_t(choice.draw(random))];
  double total = 0, chi_square = 0;
  for (const double w : weights) total += w;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double expected = n * weights[i] / total;
    if (expected == 0)
      EXPECT_EQ(counts[i], 0);
    else
      chi_square += (counts[i] - expected) * (counts[i] - expected) / expected;
  }
  EXPECT_LT(chi_square, 20.5);
  EXPECT_GT(chi_square, 0.15);  // too good a fit would be as wrong
}

TEST(WeightedChoice, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(WeightedChoice({}), std::invalid_argument);
  EXPECT_THROW(WeightedChoice({0, 0}), std::invalid_argument);
  EXPECT_THROW(WeightedChoice({1, -1}), std::invalid_argument);
}

}  // namespace random_test
}  // namespace rubble
