// A rigid transform as numbers, in the order in which datasets list matrices.
#pragma once

#include <array>

#include "kernel/base/math.h"

namespace rubble {

// The upper three rows of the 4x4 matrix, row by row.
inline std::array<double, 12> pose_rows(const Pose& pose) {
  const Mat3 r = pose.rotation.matrix();
  std::array<double, 12> rows{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows[std::size_t(4 * i + j)] = r.rows[i][j];
    rows[std::size_t(4 * i + 3)] = pose.translation[i];
  }
  return rows;
}

}  // namespace rubble
