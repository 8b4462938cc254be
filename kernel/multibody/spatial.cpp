#include "kernel/multibody/spatial.h"

#include <cmath>

namespace rubble {

SpatialMatrix invert(const SpatialMatrix& matrix) {
  double lower[6][6] = {}, inverse[6][6] = {};  // of L; L^-1
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = matrix.columns[j][i];
      for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      lower[i][j] = i == j ? std::sqrt(sum) : sum / lower[j][j];
    }
  }
  for (int j = 0; j < 6; ++j) {
    inverse[j][j] = 1 / lower[j][j];
    for (int i = j + 1; i < 6; ++i) {
      double sum = 0;
      for (int k = j; k < i; ++k) sum -= lower[i][k] * inverse[k][j];
      inverse[i][j] = sum / lower[i][i];
    }
  }
  SpatialMatrix result;
  for (int j = 0; j < 6; ++j) {
    double column[6] = {};
    for (int i = 0; i < 6; ++i) {
      for (int k = i > j ? i : j; k < 6; ++k) column[i] += inverse[k][i] * inverse[k][j];
    }
    result.columns[j] = {{column[0], column[1], column[2]}, {column[3], column[4], column[5]}};
  }
  return result;
}

}  // namespace rubble
