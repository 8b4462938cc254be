#include "kernel/multibody/cholesky.h"

#include <cmath>

namespace rubble {

bool Cholesky::factor(const SymmetricMatrix& matrix) {
  const int n = matrix.size();
  lower_ = matrix;
  inverse_diagonal_.assign(std::size_t(n), 0);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = matrix.at(i, j);
      const double *row_i = lower_.row(i), *row_j = lower_.row(j);
      for (int k = 0; k < j; ++k) sum -= row_i[k] * row_j[k];
      if (i != j) {
        lower_.at(i, j) = sum * inverse_diagonal_[std::size_t(j)];
      } else if (sum > 0) {
        lower_.at(i, i) = std::sqrt(sum);
        inverse_diagonal_[std::size_t(i)] = 1 / lower_.at(i, i);
      } else {
        lower_.resize(0);
        return false;
      }
    }
  }
  return true;
}

void Cholesky::solve(double* x) const {
  const int n = lower_.size();
  for (int i = 0; i < n; ++i) {
    const double* row = lower_.row(i);
    for (int k = 0; k < i; ++k) x[i] -= row[k] * x[k];
    x[i] *= inverse_diagonal_[std::size_t(i)];
  }
  for (int i = n - 1; i >= 0; --i) {
    x[i] *= inverse_diagonal_[std::size_t(i)];
    const double* row = lower_.row(i);
    for (int k = 0; k < i; ++k) x[k] -= row[k] * x[i];
  }
}

}  // namespace rubble
