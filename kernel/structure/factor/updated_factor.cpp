#include "kernel/structure/factor/updated_factor.h"

#include <cmath>

namespace rubble {
namespace {

// A pivot below this is a change that leaves nearly nothing of what held. unit: 1
constexpr double kSmallestPivot = 1e-9;

double product(const Six& a, const Six& b) {
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

double product(const std::vector<BlockValue>& a, const std::vector<BlockValue>& b) {
  double sum = 0;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    if (a[i].row == b[k].row) {
      sum += product(a[i++].value, b[k++].value);
    } else if (a[i].row < b[k].row) {
      ++i;
    } else {
      ++k;
    }
  }
  return sum;
}

// LU with partial pivoting, in place. False when it is singular.
bool factorize(std::vector<double>& m, std::vector<int>& pivots, int n) {
  for (int c = 0; c < n; ++c) {
    int best = c;
    for (int r = c + 1; r < n; ++r) {
      if (std::abs(m[r * n + c]) > std::abs(m[best * n + c])) best = r;
    }
    pivots[c] = best;
    if (!(std::abs(m[best * n + c]) > kSmallestPivot)) return false;
    for (int k = 0; k < n && best != c; ++k) std::swap(m[c * n + k], m[best * n + k]);
    for (int r = c + 1; r < n; ++r) {
      const double factor = m[r * n + c] /= m[c * n + c];
      for (int k = c + 1; k < n; ++k) m[r * n + k] -= factor * m[c * n + k];
    }
  }
  return true;
}

void solve_dense(const std::vector<double>& m, const std::vector<int>& pivots, std::vector<double>& x) {
  const int n = int(x.size());
  for (int c = 0; c < n; ++c) std::swap(x[c], x[pivots[c]]);
  for (int r = 0; r < n; ++r) {
    for (int k = 0; k < r; ++k) x[r] -= m[r * n + k] * x[k];
  }
  for (int r = n; r-- > 0;) {
    for (int k = r + 1; k < n; ++k) x[r] -= m[r * n + k] * x[k];
    x[r] /= m[r * n + r];
  }
}

}  // namespace

bool UpdatedFactor::reset(const BlockMatrix& matrix) {
  changes_.clear();
  products_.clear();
  prepared_ = 0;
  return regular_ = factor_.factorize(matrix);
}

void UpdatedFactor::change(const std::vector<BlockValue>& v, double weight) {
  if (weight == 0) return;
  std::vector<BlockValue> scaled = v;
  const double root = std::sqrt(std::abs(weight));
  for (BlockValue& block : scaled) {
    for (double& x : block.value) x *= root;
  }
  changes_.push_back({factor_.solve_lower(scaled), weight < 0 ? -1.0 : 1.0});
  products_.emplace_back();
  for (const Change& other : changes_) {
    products_.back().push_back(product(changes_.back().lower, other.lower));
  }
}

bool UpdatedFactor::prepare() {
  const int n = rank();
  if (prepared_ == n) return regular_;
  prepared_ = n;
  dense_.assign(std::size_t(n) * n, 0);
  pivots_.assign(n, 0);
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c <= r; ++c) dense_[r * n + c] = dense_[c * n + r] = products_[r][c];
    dense_[r * n + r] += changes_[r].sign;
  }
  return regular_ = rubble::factorize(dense_, pivots_, n);
}

bool UpdatedFactor::solve(const std::vector<Six>& right, std::vector<Six>& x) {
  if (!prepare()) return false;
  std::vector<Six> y = factor_.solve_lower(right);
  std::vector<double> shares;
  for (const Change& change : changes_) {
    double sum = 0;
    for (const BlockValue& block : change.lower) sum += product(block.value, y[block.row]);
    shares.push_back(sum);
  }
  solve_dense(dense_, pivots_, shares);
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    for (const BlockValue& block : changes_[i].lower) {
      for (int k = 0; k < 6; ++k) y[block.row][k] -= shares[i] * block.value[k];
    }
  }
  x = factor_.solve_upper(std::move(y));
  return true;
}

}  // namespace rubble
