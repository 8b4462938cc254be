// The child moves along X of the joint's frame. q: the travel; u: its rate.
#include "kernel/multibody/joints/mobilizer.h"
#include "kernel/multibody/joints/single.h"

namespace rubble {
namespace {

class Slider : public SingleJoint {
 public:
#ifndef RUBBLE_WITHOUT_SIMBODY
  void mobilize(MobilizerPlace& p) const override {
    p.made = SimTK::MobilizedBody::Slider(p.parent, p.in_parent, p.body, p.in_link);
  }
#endif
  bool holds_travel(int axis) const override { return axis != 0; }
  bool holds_turn(int) const override { return true; }
  void set_figures(const JointType& type, double s, TreeLink& link) const override {
    SingleJoint::set_figures(type, s, link);
    link.stiffness = type.stiffness * s;
    link.damping = type.damping * (s * s);
    link.friction = type.friction * (s * s);
    link.yield = type.yield * (s * s);
    link.lower = type.lower * s;
    link.upper = type.upper * s;
  }
};

}  // namespace

const Joint& slider_joint() {
  static const Slider joint;
  return joint;
}

}  // namespace rubble
