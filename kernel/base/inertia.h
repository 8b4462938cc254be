// 3 x 3 matrix functions for the inertia of rigid bodies.
#pragma once

#include "kernel/base/math.h"

namespace rubble {

// By cofactors. The determinant must not be 0.
inline Mat3 inverse_of(const Mat3& m) {
  const Vec3 c0 = cross(m.rows[1], m.rows[2]), c1 = cross(m.rows[2], m.rows[0]),
             c2 = cross(m.rows[0], m.rows[1]);
  return Mat3{{c0, c1, c2}}.transposed() * (1 / dot(m.rows[0], c0));
}

// Adds what a mass contributes about a point from which its centre is d away (parallel axes).
// inertia: unit: kg m2; mass: unit: kg; d: unit: m
inline void add_offset(Mat3& inertia, double mass, const Vec3& d) {
  const double d2 = dot(d, d);
  for (int r = 0; r < 3; ++r) {
    for (int s = 0; s < 3; ++s) inertia.rows[r][s] += mass * ((r == s ? d2 : 0.0) - d[r] * d[s]);
  }
}

// The principal moments of a symmetric matrix, and its axes as the columns of `axes`, a rotation (Golub and Van Loan,
// Matrix Computations, 8.5: Jacobi's method).
Vec3 find_principal_axes(Mat3 m, Mat3& axes);

}  // namespace rubble
