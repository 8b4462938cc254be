#include "kernel/base/inertia.h"

#include <cmath>
#include <utility>

namespace rubble {

Vec3 find_principal_axes(Mat3 m, Mat3& axes) {
  constexpr int kSweeps = 20;
  axes = Mat3::identity();
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const auto& [p, q] : {std::make_pair(0, 1), std::make_pair(0, 2), std::make_pair(1, 2)}) {
      if (m.rows[p][q] == 0) continue;
      const double tau = (m.rows[q][q] - m.rows[p][p]) / (2 * m.rows[p][q]);
      const double t = (tau >= 0 ? 1 : -1) / (std::abs(tau) + std::sqrt(1 + tau * tau));
      const double c = 1 / std::sqrt(1 + t * t), s = t * c;
      Mat3 turn = Mat3::identity();
      turn.rows[p][p] = turn.rows[q][q] = c;
      turn.rows[p][q] = s, turn.rows[q][p] = -s;
      m = turn.transposed() * m * turn;
      m.rows[p][q] = m.rows[q][p] = 0;
      axes = axes * turn;
    }
  return {m.rows[0].x, m.rows[1].y, m.rows[2].z};
}

}  // namespace rubble
