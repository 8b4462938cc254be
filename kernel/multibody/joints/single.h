// Common code of hinge and slider: one coordinate x whose rate is the speed.
#pragma once

#include "kernel/base/math.h"
#include "kernel/multibody/joints/joint.h"

namespace rubble {

class SingleJoint : public Joint {
 public:
  void move(const double* displacement, double* q) const override { q[0] += displacement[0]; }
  void calc_rates(const double*, const double* u, double* rates) const override {
    rates[0] = u[0];
  }
  void add_spring(const TreeLink& link, const double* q, double* forces) const override;
  double calc_tangent_stiffness(const TreeLink& link, const double* q,
                                const double* u) const override;
  double calc_spring_energy(const TreeLink& link, const double* q) const override;
  void creep(TreeLink& link, const double* q) const override;
  int find_stops(const TreeLink& link, const double* q, double margin,
                 JointStop* stops) const override;
};

// Torques of springs count as at their yield from this share of it.
inline constexpr double kAtYield = 0.999;

// Quaternions as coordinates.

inline Quat quat_at(const double* q) { return {q[0], q[1], q[2], q[3]}; }
inline Vec3 imaginary(const Quat& q) { return {q.x, q.y, q.z}; }

// Turns a quaternion by a rotation vector in the outer frame; the angle's error is its fifth power
// over 2,880.
inline void turn(const double* by, double* q) {
  const Vec3 v{by[0], by[1], by[2]};
  // tan(x / 2) = x / 2 (1 + x^2 / 12 + x^4 / 120 + ...)
  const double x2 = dot(v, v), half = 0.5 + x2 * (1.0 / 24);
  const Quat r = quat_at(q), spin = Quat{0, v.x, v.y, v.z} * r;
  const Quat turned = normalized(Quat{r.w + spin.w * half, r.x + spin.x * half,
                                      r.y + spin.y * half, r.z + spin.z * half});
  q[0] = turned.w, q[1] = turned.x, q[2] = turned.y, q[3] = turned.z;
}

// dq/dt at an angular velocity in the outer frame; q need not have unit length.
inline void calc_turn_rates(const double* q, const double* w, double* rates) {
  const Quat spin = Quat{0, 0.5 * w[0], 0.5 * w[1], 0.5 * w[2]} * quat_at(q);
  rates[0] = spin.w, rates[1] = spin.x, rates[2] = spin.y, rates[3] = spin.z;
}

}  // namespace rubble
