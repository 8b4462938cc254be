#include "kernel/structure/factor/block_cholesky.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/structure/factor/elimination_order.h"

namespace rubble {
namespace {

// No alias declarations: in those, clang forgets that these need no alignment.
typedef double Two __attribute__((vector_size(16), aligned(8), may_alias));
typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));

// Each row of the target stays in registers.
void subtract_by_twos(Block6& target, const Block6& a, const Block6& b) {
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

#if defined(__x86_64__)
// The same operations on the same numbers, two rows of the target at a time: they fill three registers.
__attribute__((target("avx2"))) void subtract_by_fours(Block6& target, const Block6& a, const Block6& b) {
  Four first[6], second[6], third[6];  // a row of b twice, one after the other
  for (int k = 0; k < 6; ++k) {
    const double* row = b.data() + 6 * k;
    first[k] = *reinterpret_cast<const Four*>(row);
    third[k] = *reinterpret_cast<const Four*>(row + 2);
    second[k] = Four{row[4], row[5], row[0], row[1]};
  }
  for (int i = 0; i < 6; i += 2) {
    Four* rows = reinterpret_cast<Four*>(target.data() + 6 * i);
    Four r0 = rows[0], r1 = rows[1], r2 = rows[2];
    for (int k = 0; k < 6; ++k) {
      const double x = a[6 * i + k], y = a[6 * i + 6 + k];
      r0 -= x * first[k], r1 -= Four{x, x, y, y} * second[k], r2 -= y * third[k];
    }
    rows[0] = r0, rows[1] = r1, rows[2] = r2;
  }
}
#endif

}  // namespace

SubtractProduct portable_subtract_product() { return subtract_by_twos; }

SubtractProduct best_subtract_product() {
#if defined(__x86_64__)
  static const bool avx2 = __builtin_cpu_supports("avx2");
  if (avx2) return subtract_by_fours;
#endif
  return subtract_by_twos;
}

namespace {

// Two numbers at a time, in registers that every x86-64 and arm64 has.
typedef double Two __attribute__((vector_size(16), aligned(8), may_alias));

Block6 transposed(const Block6& m) {
  Block6 t;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) t[6 * k + i] = m[6 * i + k];
  }
  return t;
}

// target -= m v.
void subtract_product(Six& target, const Block6& m, const Six& v) {
  const Two* rows = reinterpret_cast<const Two*>(m.data());
  const Two* by = reinterpret_cast<const Two*>(v.data());
  for (int i = 0; i < 6; ++i) {
    const Two sum = rows[3 * i] * by[0] + rows[3 * i + 1] * by[1] + rows[3 * i + 2] * by[2];
    target[i] -= sum[0] + sum[1];
  }
}

// target -= m^T v.
void subtract_transposed_product(Six& target, const Block6& m, const Six& v) {
  const Two* rows = reinterpret_cast<const Two*>(m.data());
  Two* sum = reinterpret_cast<Two*>(target.data());
  Two s0 = sum[0], s1 = sum[1], s2 = sum[2];
  for (int i = 0; i < 6; ++i) {
    s0 -= v[i] * rows[3 * i], s1 -= v[i] * rows[3 * i + 1], s2 -= v[i] * rows[3 * i + 2];
  }
  sum[0] = s0, sum[1] = s1, sum[2] = s2;
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

// A column of the factor has the rows of its own column of the matrix, and those of the columns whose first
// row it is.
void BlockCholesky::order(const BlockMatrix& matrix) {
  const std::int32_t n = std::int32_t(matrix.diagonal.size());
  RowNeighbours neighbours(n);
  for (const BlockEntry& entry : matrix.below) {
    neighbours[entry.row].push_back(entry.column);
    neighbours[entry.column].push_back(entry.row);
  }
  const std::vector<std::int32_t> order = find_elimination_order(neighbours, matrix.places);
  position_.assign(n, 0);
  for (std::int32_t c = 0; c < n; ++c) position_[order[c]] = c;
  std::vector<std::vector<std::int32_t>> merged(n);  // columns, by their first row
  std::vector<std::int32_t> seen(n, -1);
  starts_.assign(1, 0);
  rows_.clear();
  for (std::int32_t c = 0; c < n; ++c) {
    const auto take = [&](std::int32_t row) {
      if (row > c && seen[row] != c) seen[row] = c, rows_.push_back(row);
    };
    for (const std::int32_t other : neighbours[order[c]]) take(position_[other]);
    for (const std::int32_t earlier : merged[c]) {
      for (std::int32_t i = starts_[earlier]; i < starts_[earlier + 1]; ++i) take(rows_[i]);
    }
    std::sort(rows_.begin() + starts_[c], rows_.end());
    starts_.push_back(std::int32_t(rows_.size()));
    if (starts_[c] < starts_[c + 1]) merged[rows_[starts_[c]]].push_back(c);
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
  static const SubtractProduct subtract = best_subtract_product();
  const std::int32_t first = starts_[column], last = starts_[column + 1];
  for (std::int32_t i = first; i < last; ++i) divide_by(values_[i], diagonal_[column]);
  for (std::int32_t k = first; k < last; ++k) {
    const std::int32_t target = rows_[k];
    const Block6 turned = transposed(values_[k]);
    subtract(diagonal_[target], values_[k], turned);
    for (std::int32_t i = starts_[target]; i < starts_[target + 1]; ++i) place[rows_[i]] = i;
    for (std::int32_t i = k + 1; i < last; ++i) {
      subtract(values_[place[rows_[i]]], values_[i], turned);
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

void BlockCholesky::solve_diagonal(std::int32_t column, Six& y) const {
  const Block6& lower = diagonal_[column];
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < i; ++k) y[i] -= lower[6 * i + k] * y[k];
    y[i] /= lower[7 * i];
  }
}

std::vector<Six> BlockCholesky::solve_lower(const std::vector<Six>& right) const {
  const std::int32_t n = std::int32_t(diagonal_.size());
  std::vector<Six> y(n);
  for (std::int32_t i = 0; i < n; ++i) y[position_[i]] = right[i];
  for (std::int32_t c = 0; c < n; ++c) {
    solve_diagonal(c, y[c]);
    for (std::int32_t e = starts_[c]; e < starts_[c + 1]; ++e) {
      subtract_product(y[rows_[e]], values_[e], y[c]);
    }
  }
  return y;
}

// The rows of a column lie on its way to the root, and its first one is the next on that way.
std::vector<BlockValue> BlockCholesky::solve_lower(const std::vector<BlockValue>& right) const {
  std::vector<std::int32_t> columns;
  for (const BlockValue& block : right) {
    std::int32_t c = position_[block.row];
    columns.push_back(c);
    while (starts_[c] < starts_[c + 1]) columns.push_back(c = rows_[starts_[c]]);
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  std::vector<BlockValue> y;
  for (const std::int32_t c : columns) y.push_back({c, {}});
  const auto find = [&](std::size_t from, std::int32_t row) {
    while (columns[from] != row) ++from;
    return from;
  };
  for (const BlockValue& block : right) y[find(0, position_[block.row])].value = block.value;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::int32_t c = columns[i];
    solve_diagonal(c, y[i].value);
    std::size_t at = i;
    for (std::int32_t e = starts_[c]; e < starts_[c + 1]; ++e) {
      at = find(at, rows_[e]);
      subtract_product(y[at].value, values_[e], y[i].value);
    }
  }
  return y;
}

std::vector<Six> BlockCholesky::solve_upper(std::vector<Six> y) const {
  for (std::size_t c = y.size(); c-- > 0;) {
    for (std::int32_t e = starts_[c]; e < starts_[c + 1]; ++e) {
      subtract_transposed_product(y[c], values_[e], y[rows_[e]]);
    }
    for (int i = 6; i-- > 0;) {
      for (int k = i + 1; k < 6; ++k) y[c][i] -= diagonal_[c][6 * k + i] * y[c][k];
      y[c][i] /= diagonal_[c][7 * i];
    }
  }
  std::vector<Six> x(y.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = y[position_[i]];
  return x;
}

}  // namespace rubble
