// Which joint is which. No switch here has a default: a case that is missing does not compile.
#include "kernel/multibody/joints/joint.h"

#include <cstdlib>

namespace rubble {

const Joint& joint_of(Mobility mobility) {
  switch (mobility) {
    case Mobility::free:
      return free_root();
    case Mobility::fixed:
      return fixed_root();
    case Mobility::weld:
      return weld_joint();
    case Mobility::hinge:
      return hinge_joint();
    case Mobility::slider:
      return slider_joint();
    case Mobility::ball:
      return ball_joint();
  }
  std::abort();  // no such number
}

Mobility mobility_of(JointKind kind) {
  switch (kind) {
    case JointKind::weld:
      return Mobility::weld;
    case JointKind::hinge:
      return Mobility::hinge;
    case JointKind::slider:
      return Mobility::slider;
    case JointKind::ball:
      return Mobility::ball;
  }
  std::abort();
}

JointKind kind_of(Mobility mobility) {
  switch (mobility) {
    case Mobility::free:
    case Mobility::fixed:
    case Mobility::weld:
      return JointKind::weld;
    case Mobility::hinge:
      return JointKind::hinge;
    case Mobility::slider:
      return JointKind::slider;
    case Mobility::ball:
      return JointKind::ball;
  }
  std::abort();
}

// What a joint without speeds does.
void Joint::move(const double*, double*) const {}
void Joint::calc_rates(const double*, const double*, double*) const {}
void Joint::add_spring(const TreeLink&, const double*, double*) const {}
double Joint::calc_tangent_stiffness(const TreeLink&, const double*, const double*) const {
  return 0;
}
double Joint::calc_spring_energy(const TreeLink&, const double*) const { return 0; }
void Joint::creep(TreeLink&, const double*) const {}
int Joint::find_stops(const TreeLink&, const double*, double, JointStop*) const { return 0; }

void Joint::set_figures(const JointType& type, double s, TreeLink& link) const {
  const double s2 = s * s, s3 = s2 * s;
  link.stiffness = type.stiffness * s3;
  link.damping = type.damping * (s3 * s);
  link.friction = type.friction * s3;
  link.yield = type.yield * s3;
  link.break_force = type.break_force * s2;
  link.break_torque = type.break_torque * s3;
  link.lower = type.lower;
  link.upper = type.upper;
  link.collide = type.collide;
}

}  // namespace rubble
