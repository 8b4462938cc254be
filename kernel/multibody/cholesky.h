// Symmetric positive definite systems of a few dozen unknowns, in a fixed order of operations (no
// LAPACK: its order depends on the library and the processor).
#pragma once

#include <vector>

namespace rubble {

// Row-major; the lower triangle is what counts.
class SymmetricMatrix {
 public:
  void resize(int size) {
    size_ = size;
    values_.assign(std::size_t(size) * std::size_t(size), 0);
  }
  int size() const { return size_; }
  // row >= column
  double& at(int row, int column) { return values_[std::size_t(row * size_ + column)]; }
  double at(int row, int column) const { return values_[std::size_t(row * size_ + column)]; }
  const double* row(int i) const { return values_.data() + std::size_t(i * size_); }

 private:
  int size_ = 0;
  std::vector<double> values_;
};

// A = L L^T.
class Cholesky {
 public:
  // Returns false, and keeps nothing, where `matrix` is not positive definite.
  bool factor(const SymmetricMatrix& matrix);
  int size() const { return lower_.size(); }
  // Solves in place.
  void solve(double* x) const;

 private:
  SymmetricMatrix lower_;
  std::vector<double> inverse_diagonal_;
};

}  // namespace rubble
