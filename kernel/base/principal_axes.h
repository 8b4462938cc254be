#pragma once

#include "kernel/base/math.h"

namespace rubble {

// The principal moments of a symmetric matrix, and its axes as the columns of `axes`, a rotation (Golub and Van Loan,
// Matrix Computations, 8.5: Jacobi's method).
Vec3 find_principal_axes(Mat3 m, Mat3& axes);

}  // namespace rubble
