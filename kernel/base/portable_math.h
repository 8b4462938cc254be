// sin, cos, exp and the like with the same bits on every machine.
//
// libm's transcendentals change in the last bits between versions and between CPU variants of one
// version. These use only +, -, *, / and sqrt, which IEEE 754 rounds exactly, so a result that
// depends on them is the same wherever -ffp-contract=off holds. Accuracy: within 2 ulp or 1e-15
// absolute over the stated ranges, against libm (tests/base).
#pragma once

#include "kernel/base/math.h"

namespace rubble::portable {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr float kPiF = float(kPi);

struct SinCos {
  double sin, cos;  // of the same angle; range: -1 to 1
};

// unit: rad; range: |x| <= 1e6.
SinCos sincos(double x);
inline double sin(double x) { return sincos(x).sin; }
inline double cos(double x) { return sincos(x).cos; }
// range: |x| <= 1; result in [0, pi] and [-pi/2, pi/2].
double acos(double x);
double asin(double x);
// result in (-pi, pi]; atan2(0, 0) = 0.
double atan2(double y, double x);
// range: |x| <= 700.
double exp(double x);
// range: x > 0, normal.
double log(double x);

// The rotation of a robot's roll, pitch and yaw (REP 103): R = Rz(yaw) Ry(pitch) Rx(roll), so a
// positive pitch lowers the nose of a camera that looks along X. unit: rad.
Quat quat_from_rpy(double roll, double pitch, double yaw);
// {roll, pitch, yaw} of a rotation; where it looks straight up or down, yaw is 0.
Vec3 rpy_from_quat(const Quat& rotation);
// Shortest-arc interpolation at constant angular speed; t in [0, 1].
Quat slerp(const Quat& a, const Quat& b, double t);

}  // namespace rubble::portable
