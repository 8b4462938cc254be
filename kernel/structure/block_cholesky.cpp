#include "kernel/structure/block_cholesky.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace rubble {
namespace {

// Two numbers at a time, in registers that every x86-64 and arm64 has.
using Two = double __attribute__((vector_size(16), aligned(8), may_alias));

Block6 transposed(const Block6& m) {
  Block6 t;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) t[6 * k + i] = m[6 * i + k];
  }
  return t;
}

// target -= a * b. The innermost loop over all the work: each row of the target stays in registers.
void subtract_product(Block6& target, const Block6& a, const Block6& b) {
  const Two* rows = reinterpret_cast<const Two*>(b.data());
  for (int i = 0; i < 6; ++i) {
    Two* row = reinterpret_cast<Two*>(target.data() + 6 * i);
    Two r0 = row[0], r1 = row[1], r2 = row[2];
    for (int k = 0; k < 6; ++k) {
      const double x = a[6 * i + k];
      r0 -= x * rows[3 * k], r1 -= x * rows[3 * k + 1], r2 -= x * rows[3 * k + 2];
    }
    row[0] = r0, row[1] = r1, row[2] = r2;
  }
}

bool factorize_block(Block6& m) {
  for (int j = 0; j < 6; ++j) {
    double pivot = m[7 * j];
    for (int k = 0; k < j; ++k) pivot -= m[6 * j + k] * m[6 * j + k];
    if (!(pivot > 0)) return false;
    m[7 * j] = std::sqrt(pivot);
    for (int i = j + 1; i < 6; ++i) {
      double sum = m[6 * i + j];
      for (int k = 0; k < j; ++k) sum -= m[6 * i + k] * m[6 * j + k];
      m[6 * i + j] = sum / m[7 * j];
    }
  }
  return true;
}

// m L^-T, in place.
void divide_by(Block6& m, const Block6& lower) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      double sum = m[6 * i + j];
      for (int k = 0; k < j; ++k) sum -= m[6 * i + k] * lower[6 * j + k];
      m[6 * i + j] = sum / lower[7 * j];
    }
  }
}

}  // namespace

// Eliminates the piece with the fewest neighbours again and again; its neighbours then all know each
// other. What is left of a column is its structure in the factor.
void BlockCholesky::order(const BlockMatrix& matrix) {
  const std::size_t n = matrix.diagonal.size();
  std::vector<std::vector<std::int32_t>> neighbours(n);
  for (const BlockEntry& entry : matrix.below) {
    neighbours[entry.row].push_back(entry.column);
    neighbours[entry.column].push_back(entry.row);
  }
  std::set<std::pair<std::int32_t, std::int32_t>> queue;
  for (std::size_t i = 0; i < n; ++i) {
    std::sort(neighbours[i].begin(), neighbours[i].end());
    queue.insert({std::int32_t(neighbours[i].size()), std::int32_t(i)});
  }
  position_.assign(n, 0);
  std::vector<std::vector<std::int32_t>> columns;
  std::vector<std::int32_t> joined;
  while (!queue.empty()) {
    const std::int32_t piece = queue.begin()->second;
    queue.erase(queue.begin());
    position_[piece] = std::int32_t(columns.size());
    const std::vector<std::int32_t> left = std::move(neighbours[piece]);
    for (const std::int32_t other : left) {
      std::vector<std::int32_t>& theirs = neighbours[other];
      queue.erase({std::int32_t(theirs.size()), other});
      joined.clear();
      std::set_union(theirs.begin(), theirs.end(), left.begin(), left.end(),
                     std::back_inserter(joined));
      theirs.clear();
      for (const std::int32_t i : joined) {
        if (i != other && i != piece) theirs.push_back(i);
      }
      queue.insert({std::int32_t(theirs.size()), other});
    }
    columns.push_back(left);
  }
  starts_.assign(1, 0);
  rows_.clear();
  for (std::vector<std::int32_t>& column : columns) {
    for (std::int32_t& row : column) row = position_[row];
    std::sort(column.begin(), column.end());
    rows_.insert(rows_.end(), column.begin(), column.end());
    starts_.push_back(std::int32_t(rows_.size()));
  }
}

void BlockCholesky::scatter(const BlockMatrix& matrix) {
  values_.assign(rows_.size(), Block6{});
  diagonal_.resize(matrix.diagonal.size());
  for (std::size_t i = 0; i < matrix.diagonal.size(); ++i) diagonal_[position_[i]] = matrix.diagonal[i];
  for (const BlockEntry& entry : matrix.below) {
    std::int32_t row = position_[entry.row], column = position_[entry.column];
    const bool turned = row < column;
    if (turned) std::swap(row, column);
    const auto first = rows_.begin() + starts_[column], last = rows_.begin() + starts_[column + 1];
    Block6& target = values_[std::size_t(std::lower_bound(first, last, row) - rows_.begin())];
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) target[6 * i + j] += entry.values[turned ? 6 * j + i : 6 * i + j];
    }
  }
}

// Takes a finished column out of all that come after it. place: scratch, by row.
bool BlockCholesky::eliminate(std::int32_t column, std::vector<std::int32_t>& place) {
  if (!factorize_block(diagonal_[column])) return false;
  const std::int32_t first = starts_[column], last = starts_[column + 1];
  for (std::int32_t i = first; i < last; ++i) divide_by(values_[i], diagonal_[column]);
  for (std::int32_t k = first; k < last; ++k) {
    const std::int32_t target = rows_[k];
    const Block6 turned = transposed(values_[k]);
    subtract_product(diagonal_[target], values_[k], turned);
    for (std::int32_t i = starts_[target]; i < starts_[target + 1]; ++i) place[rows_[i]] = i;
    for (std::int32_t i = k + 1; i < last; ++i) {
      subtract_product(values_[place[rows_[i]]], values_[i], turned);
    }
  }
  return true;
}

bool BlockCholesky::factorize(const BlockMatrix& matrix) {
  order(matrix);
  scatter(matrix);
  std::vector<std::int32_t> place(matrix.diagonal.size(), 0);
  for (std::int32_t column = 0; column < std::int32_t(matrix.diagonal.size()); ++column) {
    if (!eliminate(column, place)) return false;
  }
  return true;
}

std::vector<Six> BlockCholesky::solve(const std::vector<Six>& right) const {
  const std::size_t n = diagonal_.size();
  std::vector<Six> x(n);
  for (std::size_t i = 0; i < n; ++i) x[position_[i]] = right[i];
  for (std::size_t c = 0; c < n; ++c) {
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < i; ++k) x[c][i] -= diagonal_[c][6 * i + k] * x[c][k];
      x[c][i] /= diagonal_[c][7 * i];
    }
    for (std::int32_t e = starts_[c]; e < starts_[c + 1]; ++e) {
      Six& other = x[rows_[e]];
      for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 6; ++k) other[i] -= values_[e][6 * i + k] * x[c][k];
      }
    }
  }
  for (std::size_t c = n; c-- > 0;) {
    for (std::int32_t e = starts_[c]; e < starts_[c + 1]; ++e) {
      const Six& other = x[rows_[e]];
      for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 6; ++k) x[c][k] -= values_[e][6 * i + k] * other[i];
      }
    }
    for (int i = 6; i-- > 0;) {
      for (int k = i + 1; k < 6; ++k) x[c][i] -= diagonal_[c][6 * k + i] * x[c][k];
      x[c][i] /= diagonal_[c][7 * i];
    }
  }
  std::vector<Six> result(n);
  for (std::size_t i = 0; i < n; ++i) result[i] = x[position_[i]];
  return result;
}

}  // namespace rubble
