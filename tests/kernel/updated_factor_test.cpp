#include "kernel/structure/factor/updated_factor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/random.h"

namespace rubble {
namespace updated_factor_test {

constexpr int kRows = 12;

BlockValue random_block(RandomStream& random, int row) {
  BlockValue block{row, {}};
  for (double& x : block.value) x = random.uniform(-1, 1);
  return block;
}

Block6& find_entry(BlockMatrix& matrix, int row, int column) {
  for (BlockEntry& entry : matrix.below) {
    if (entry.row == row && entry.column == column) return entry.values;
  }
  matrix.below.push_back({row, column, {}});
  return matrix.below.back().values;
}

// Adds weight v v^T.
void add_change(BlockMatrix& matrix, const std::vector<BlockValue>& v, double weight) {
  for (const BlockValue& a : v) {
    for (const BlockValue& b : v) {
      if (a.row < b.row) continue;
      Block6 product;
      for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 6; ++k) product[6 * i + k] = weight * a.value[i] * b.value[k];
      }
      if (a.row == b.row) {
        for (int i = 0; i < 36; ++i) matrix.diagonal[a.row][i] += product[i];
      } else {
        Block6& entry = find_entry(matrix, a.row, b.row);
        for (int i = 0; i < 36; ++i) entry[i] += product[i];
      }
    }
  }
}

// A ring of blocks that are held by springs between neighbours, and by one spring each.
BlockMatrix make_ring(RandomStream& random) {
  BlockMatrix matrix;
  matrix.diagonal.assign(kRows, Block6{});
  for (int i = 0; i < kRows; ++i) matrix.places.push_back({double(i), 0, 0});
  for (int i = 0; i < kRows; ++i) {
    for (int k = 0; k < 6; ++k) matrix.diagonal[i][7 * k] += 0.1;
    for (int spring = 0; spring < 6; ++spring) {
      add_change(matrix, {random_block(random, i), random_block(random, (i + 1) % kRows)}, 2);
    }
  }
  return matrix;
}

double largest_difference(const std::vector<Six>& a, const std::vector<Six>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int k = 0; k < 6; ++k) most = std::max(most, std::abs(a[i][k] - b[i][k]));
  }
  return most;
}

TEST(BlockProduct, IsTheSameBitsInWideRegisters) {
  RandomStream random(3, "test");
  Block6 a, b, narrow;
  for (int round = 0; round < 100; ++round) {
    for (Block6* block : {&a, &b, &narrow}) {
      for (double& x : *block) x = random.uniform(-1, 1);
    }
    Block6 wide = narrow, plain = narrow;
    portable_subtract_product()(narrow, a, b);
    best_subtract_product()(wide, a, b);
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 6; ++k) {
        for (int j = 0; j < 6; ++j) plain[6 * i + k] -= a[6 * i + j] * b[6 * j + k];
      }
    }
    EXPECT_EQ(narrow, plain);
    EXPECT_EQ(wide, plain);
  }
}

// 900 rows, of which the order of elimination parts most. Row by row the factor would have 30 blocks a row.
TEST(BlockCholesky, OfAGridIsExactAndSmall) {
  constexpr int kEdge = 30;
  RandomStream random(5, "test");
  BlockMatrix matrix;
  matrix.diagonal.assign(kEdge * kEdge, Block6{});
  std::vector<Six> x(kEdge * kEdge), right(kEdge * kEdge, Six{});
  for (int row = 0; row < kEdge * kEdge; ++row) {
    matrix.places.push_back({double(row % kEdge), double(row / kEdge), 0});
    for (int k = 0; k < 6; ++k) matrix.diagonal[row][7 * k] = 5, x[row][k] = random.uniform(-1, 1);
    for (const int other : {row - 1, row - kEdge}) {
      if (other < 0 || (other == row - 1 && row % kEdge == 0)) continue;
      matrix.below.push_back({row, other, {}});
      for (int k = 0; k < 6; ++k) matrix.below.back().values[7 * k] = -1;
    }
  }
  for (std::size_t row = 0; row < x.size(); ++row) {
    for (int k = 0; k < 6; ++k) right[row][k] = 5 * x[row][k];
  }
  for (const BlockEntry& entry : matrix.below) {
    for (int k = 0; k < 6; ++k) {
      right[entry.row][k] -= x[entry.column][k], right[entry.column][k] -= x[entry.row][k];
    }
  }
  BlockCholesky factor;
  ASSERT_TRUE(factor.factorize(matrix));
  EXPECT_LT(largest_difference(factor.solve(right), x), 1e-12);
  EXPECT_LT(factor.blocks(), 15u * kEdge * kEdge);
}

TEST(UpdatedFactor, GivesWhatAFactorOfTheChangedMatrixGives) {
  RandomStream random(7, "test");
  BlockMatrix matrix = make_ring(random);
  UpdatedFactor updated;
  ASSERT_TRUE(updated.reset(matrix));
  std::vector<Six> right, x;
  for (int i = 0; i < kRows; ++i) right.push_back(random_block(random, i).value);
  for (int round = 0; round < 30; ++round) {
    const int row = round % kRows;
    const std::vector<BlockValue> v = {random_block(random, row), random_block(random, (row + 1) % kRows)};
    const double weight = round % 3 == 2 ? -0.02 : 3.0;
    updated.change(v, weight);
    add_change(matrix, v, weight);
    BlockCholesky anew;
    ASSERT_TRUE(anew.factorize(matrix)) << round;
    ASSERT_TRUE(updated.solve(right, x)) << round;
    EXPECT_LT(largest_difference(x, anew.solve(right)), 1e-9) << round;
  }
  EXPECT_EQ(updated.rank(), 30);
  ASSERT_TRUE(updated.reset(matrix));
  EXPECT_EQ(updated.rank(), 0);
}

TEST(UpdatedFactor, RefusesWhatNothingHoldsAnyMore) {
  BlockMatrix matrix;
  matrix.diagonal.assign(2, Block6{});
  matrix.places.assign(2, Vec3{});
  for (Block6& block : matrix.diagonal) {
    for (int k = 0; k < 6; ++k) block[7 * k] = 4;
  }
  UpdatedFactor factor;
  ASSERT_TRUE(factor.reset(matrix));
  BlockValue v{1, {}};
  v.value[3] = 1;
  std::vector<Six> x;
  factor.change({v}, -2);
  EXPECT_TRUE(factor.solve({Six{}, Six{0, 0, 0, 1, 0, 0}}, x));
  EXPECT_NEAR(x[1][3], 0.5, 1e-12);
  factor.change({v}, -2);
  EXPECT_FALSE(factor.solve({Six{}, Six{0, 0, 0, 1, 0, 0}}, x));
}

}  // namespace updated_factor_test
}  // namespace rubble
