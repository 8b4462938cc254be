// Turns in every direction. q: a quaternion; u: the angular velocity in the joint's frame on the
// parent.
#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/joints/mobilizer.h"
#include "kernel/multibody/joints/single.h"

namespace rubble {
namespace {

// From the spring's rest to where the joint is, by the shorter way; along the parent's axes.
Quat calc_bend(const TreeLink& link, const double* q) {
  const Quat bend = quat_at(q) * link.rest_rotation.conjugate();
  return bend.w < 0 ? Quat{-bend.w, -bend.x, -bend.y, -bend.z} : bend;
}

class Ball : public Joint {
 public:
#ifndef RUBBLE_WITHOUT_SIMBODY
  void mobilize(MobilizerPlace& p) const override {
    p.made = SimTK::MobilizedBody::Ball(p.parent, p.in_parent, p.body, p.in_link);
  }
#endif
  bool holds_travel(int) const override { return true; }
  bool holds_turn(int) const override { return false; }
  void move(const double* displacement, double* q) const override { turn(displacement, q); }
  void calc_rates(const double* q, const double* u, double* rates) const override {
    calc_turn_rates(q, u, rates);
  }
  void set_figures(const JointType& type, double s, TreeLink& link) const override {
    Joint::set_figures(type, s, link);
    link.lower = -kNever;
  }

  void add_spring(const TreeLink& link, const double* q, double* forces) const override {
    if (link.stiffness <= 0) return;
    const Vec3 torque = imaginary(calc_bend(link, q)) * (-2 * link.stiffness);
    for (int i = 0; i < 3; ++i) forces[i] += torque[i];
  }
  double calc_tangent_stiffness(const TreeLink& link, const double* q,
                                const double* u) const override {
    if (link.stiffness <= 0 || link.yield == kNever) return link.stiffness;
    const Vec3 bend = imaginary(calc_bend(link, q));
    const bool outwards = dot(bend, Vec3{u[0], u[1], u[2]}) >= 0;
    const bool yields = 2 * norm(bend) >= kAtYield * link.yield / link.stiffness && outwards;
    return yields ? 0 : link.stiffness;
  }
  // 4 k (1 - cos(x / 2)), written so that small angles keep their digits.
  double calc_spring_energy(const TreeLink& link, const double* q) const override {
    if (link.stiffness <= 0) return 0;
    const Quat bend = calc_bend(link, q);
    return 4 * link.stiffness * dot(imaginary(bend), imaginary(bend)) / (1 + bend.w);
  }
  void creep(TreeLink& link, const double* q) const override {
    if (link.stiffness <= 0 || link.yield == kNever) return;
    const Vec3 v = imaginary(calc_bend(link, q));
    const double sine = norm(v), most = 0.5 * link.yield / link.stiffness;
    if (sine <= most) return;
    const Vec3 kept = v * (most / sine);
    const double cosine = std::sqrt(1 - most * most);
    link.rest_rotation = normalized(Quat{cosine, -kept.x, -kept.y, -kept.z} * quat_at(q));
  }

  int find_stops(const TreeLink& link, const double* q, double margin,
                 JointStop* stops) const override {
    if (link.upper == kNever) return 0;
    const Quat r = quat_at(q);
    const Vec3 v = imaginary(r) * (r.w < 0 ? -1.0 : 1.0);
    const double sine = norm(v);
    if (sine < 1e-9) return 0;
    // d(2 sin(x / 2)) = cos(x / 2) dx
    const double cosine = std::max(0.05, std::abs(r.w));
    const double gap = 2 * (portable::sin(0.5 * link.upper) - sine) / cosine;
    if (gap >= margin) return 0;
    stops[0] = {gap, {-v.x / sine, -v.y / sine, -v.z / sine}};
    return 1;
  }
};

}  // namespace

const Joint& ball_joint() {
  static const Ball joint;
  return joint;
}

}  // namespace rubble
