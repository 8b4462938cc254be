// Holds everything, until it breaks.
#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/joints/mobilizer.h"

namespace rubble {
namespace {

class Weld : public Joint {
 public:
#ifndef RUBBLE_WITHOUT_SIMBODY
  void mobilize(MobilizerPlace& p) const override {
    p.made = SimTK::MobilizedBody::Weld(p.parent, p.in_parent, p.body, p.in_link);
  }
#endif
  bool holds_travel(int) const override { return true; }
  bool holds_turn(int) const override { return true; }
};

}  // namespace

const Joint& weld_joint() {
  static const Weld joint;
  return joint;
}

}  // namespace rubble
