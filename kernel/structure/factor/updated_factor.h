// A Cholesky factor that follows small changes of its matrix without being made anew.
//
// K = K0 + sum of w v v^T, with K0 = L L^T. By the Woodbury identity (Hager 1989, "Updating the inverse of
// a matrix") K x = b costs one solution with L and a dense system as large as the number of changes. Only
// L^-1 v is kept of each v: v belongs to one or two pieces, and L^-1 v is zero but on their way to the root
// of the elimination tree.
#pragma once

#include <utility>
#include <vector>

#include "kernel/structure/factor/block_cholesky.h"

namespace rubble {

class UpdatedFactor {
 public:
  // Forgets all changes. False when the matrix is not positive definite.
  bool reset(const BlockMatrix& matrix);

  // Adds weight v v^T. v: by block row, each row once.
  void change(const std::vector<BlockValue>& v, double weight);
  int rank() const { return int(changes_.size()); }

  // False when the changed matrix is singular, or too nearly so for this way.
  bool solve(const std::vector<Six>& right, std::vector<Six>& x);

 private:
  struct Change {
    std::vector<BlockValue> lower;  // L^-1 v, by position in the order of elimination, ascending
    double sign = 1;                // of its weight; the root of its size is in v
  };

  bool prepare();

  BlockCholesky factor_;
  std::vector<Change> changes_;
  std::vector<std::vector<double>> products_;  // lower triangle: of the changes' L^-1 v
  std::vector<double> dense_;                  // LU of diag(signs) + products, row by row
  std::vector<int> pivots_;
  int prepared_ = 0;                           // rank that dense_ is made for
  bool regular_ = true;
};

}  // namespace rubble
