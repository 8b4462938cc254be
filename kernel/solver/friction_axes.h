// The axes along which friction at a contact is solved. Not for use outside kernel/.
//
// An impulse along one tangent changes the speed along the other by k01 of the matrix
// K = J M^-1 J^T of the two. Solved side by side as if k01 were zero, they answer each other's
// impulses: where k01^2 > k00 k11 / 9 (a bar touched off its middle) the answers grow from substep
// to substep, change sign in each, and are stopped only by the friction cone; the bar creeps for
// ever. Along the principal axes of K there is no k01, and what is found side by side is exact.
#pragma once

#include "kernel/solver/contact_law.h"

namespace rubble {

// Turns a pair of tangents, or of anything linear in them, about the normal.
template <typename T>
struct PlaneTurn {
  T cosine, sine;

  template <typename V>
  RUBBLE_INLINE void apply(V& first, V& second) const {
    const V old = first;
    first = old * cosine + second * sine;
    second = second * cosine - old * sine;
  }
};

// The turn from tangents with the matrix K to its principal axes, by 45 degrees at most.
// tan(2 angle) = 2 k01 / (k00 - k11) (Golub and Van Loan, Matrix Computations, 8.5: Jacobi methods).
template <typename T>
RUBBLE_INLINE PlaneTurn<T> find_friction_axes(T k00, T k01, T k11) {
  using contact_law::choose, contact_law::root;
  const auto uncoupled = k01 == T{};
  const T tau = (k11 - k00) / choose(uncoupled, T(1), T(2) * k01);
  const T length = root(T(1) + tau * tau);
  const T tangent = choose(tau >= T{}, T(-1) / (tau + length), T(1) / (length - tau));
  const T cosine = T(1) / root(T(1) + tangent * tangent);
  return {choose(uncoupled, T(1), cosine), choose(uncoupled, T{}, tangent * cosine)};
}

}  // namespace rubble
