// Direct solution of K x = b for a symmetric, positive definite K of 6 x 6 blocks: one block row a piece,
// one block off the diagonal a bond.
//
// A sparse block Cholesky factor. Written out because the order of every operation is then the same on every
// machine.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Products of 6 x 6 blocks, in which a factorization spends its time.
using Block6 = std::array<double, 36>;  // row by row
using Six = std::array<double, 6>;

// target -= a b
using SubtractProduct = void (*)(Block6& target, const Block6& a, const Block6& b);

// On two numbers at a time, as every x86-64 and arm64 does.
SubtractProduct portable_subtract_product();
// The widest that this machine has; the same operations on the same numbers, so the same bits.
SubtractProduct best_subtract_product();

struct BlockEntry {
  std::int32_t row = 0, column = 0;  // row > column
  Block6 values{};                   // of the block, row by row
};

struct BlockMatrix {
  std::vector<Block6> diagonal;   // one a block row
  std::vector<BlockEntry> below;  // each pair once, in any fixed order
  std::vector<Vec3> places;       // of the block rows: rows with a common entry are near each other
};

struct BlockValue {
  std::int32_t row = 0;
  Six value{};
};

class BlockCholesky {
 public:
  // False when the matrix is not positive definite; nothing must be solved then.
  bool factorize(const BlockMatrix& matrix);
  std::vector<Six> solve(const std::vector<Six>& right) const { return solve_upper(solve_lower(right)); }
  // K = L L^T: y of L y = right, in the order of elimination, and x of L^T x = y, by block row.
  std::vector<Six> solve_lower(const std::vector<Six>& right) const;
  std::vector<Six> solve_upper(std::vector<Six> y) const;
  // For a right side that has few blocks: those of y that are not zero, ascending.
  std::vector<BlockValue> solve_lower(const std::vector<BlockValue>& right) const;
  std::size_t blocks() const { return values_.size(); }  // of the factor, below its diagonal

 private:
  void order(const BlockMatrix& matrix);
  void scatter(const BlockMatrix& matrix);
  bool eliminate(std::int32_t column, std::vector<std::int32_t>& place);
  void solve_diagonal(std::int32_t column, Six& y) const;

  std::vector<std::int32_t> position_;  // of a piece in the order of elimination
  std::vector<std::int32_t> starts_;    // of each column in rows_ and values_
  std::vector<std::int32_t> rows_;      // by column, ascending
  std::vector<Block6> values_;
  std::vector<Block6> diagonal_;        // lower triangles
};

}  // namespace rubble
