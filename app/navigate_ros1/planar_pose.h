// Where something is on the ground, and which way it looks.
#pragma once

#include "kernel/base/portable_math.h"

namespace rubble {

struct PlanarPose {
  double x = 0, y = 0, yaw = 0;  // unit: m, rad
};

// Into -pi to pi; range: |angle| <= 1e6.
inline double wrapped(double angle) { return portable::atan2(portable::sin(angle), portable::cos(angle)); }

// As Pose: a_from_b * b_from_c.
inline PlanarPose operator*(const PlanarPose& a, const PlanarPose& b) {
  const portable::SinCos t = portable::sincos(a.yaw);
  return {a.x + t.cos * b.x - t.sin * b.y, a.y + t.sin * b.x + t.cos * b.y, wrapped(a.yaw + b.yaw)};
}
inline PlanarPose inverse(const PlanarPose& a) {
  const portable::SinCos t = portable::sincos(a.yaw);
  return {-t.cos * a.x - t.sin * a.y, t.sin * a.x - t.cos * a.y, -a.yaw};
}
inline Vec3 operator*(const PlanarPose& a, const Vec3& p) {
  const portable::SinCos t = portable::sincos(a.yaw);
  return {a.x + t.cos * p.x - t.sin * p.y, a.y + t.sin * p.x + t.cos * p.y, p.z};
}

}  // namespace rubble
