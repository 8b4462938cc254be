// The axes along which friction at a contact is solved. Not for use outside kernel/.
//
// An impulse along one tangent changes the speed along the other by k01 of the matrix
// K = J M^-1 J^T of the two. Solved side by side as if k01 were zero, they answer each other's
// impulses: where k01^2 > k00 k11 / 9 (a bar touched off its middle) the answers grow from substep
// to substep, change sign in each, and are stopped only by the friction cone; the bar creeps for
// ever. Along the principal axes of K there is no k01, and what is found side by side is exact.
#pragma once

#include <cmath>

namespace rubble {

// Turns a pair of tangents, or of anything linear in them, about the normal.
template <typename T>
struct PlaneTurn {
  T cosine = 1, sine = 0;

  template <typename V>
  void apply(V& first, V& second) const {
    const V old = first;
    first = old * cosine + second * sine;
    second = second * cosine - old * sine;
  }
};

// The turn from tangents with the matrix K to its principal axes, by 45 degrees at most.
// tan(2 angle) = 2 k01 / (k00 - k11) (Golub and Van Loan, Matrix Computations, 8.5: Jacobi methods).
template <typename T>
PlaneTurn<T> find_friction_axes(T k00, T k01, T k11) {
  if (k01 == 0) return {};
  const T tau = (k11 - k00) / (2 * k01);
  const T root = std::sqrt(1 + tau * tau);
  const T tangent = tau >= 0 ? -1 / (tau + root) : 1 / (root - tau);
  const T cosine = 1 / std::sqrt(1 + tangent * tangent);
  return {cosine, tangent * cosine};
}

}  // namespace rubble
