// What a tree stands on: the world, freely or not at all.
#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/joints/mobilizer.h"
#include "kernel/multibody/joints/single.h"

namespace rubble {
namespace {

// q: quaternion w x y z, position; u: angular, linear velocity in the world.
//
// A Translation that carries a Ball: Simbody inverts the 3 x 3 matrices of these in closed form,
// but leaves the 6 x 6 matrix of its Free mobilizer to LAPACK, whose last bits depend on the
// library and the processor.
class FreeRoot : public Joint {
 public:
#ifndef RUBBLE_WITHOUT_SIMBODY
  void mobilize(MobilizerPlace& p) const override {
    const SimTK::Body::Rigid nothing(
        SimTK::MassProperties(0, SimTK::Vec3(0), SimTK::Inertia(0)));
    SimTK::MobilizedBody::Translation carrier(p.parent, SimTK::Transform(), nothing,
                                              SimTK::Transform());
    p.made = SimTK::MobilizedBody::Ball(carrier, SimTK::Transform(), p.body, SimTK::Transform());
  }
#endif
  bool holds_travel(int) const override { return false; }
  bool holds_turn(int) const override { return false; }
  void move(const double* displacement, double* q) const override {
    turn(displacement, q);
    for (int i = 0; i < 3; ++i) q[4 + i] += displacement[3 + i];
  }
  void calc_rates(const double* q, const double* u, double* rates) const override {
    calc_turn_rates(q, u, rates);
    for (int i = 0; i < 3; ++i) rates[4 + i] = u[3 + i];
  }
};

class FixedRoot : public Joint {
 public:
#ifndef RUBBLE_WITHOUT_SIMBODY
  void mobilize(MobilizerPlace& p) const override { p.made = p.parent; }
#endif
  bool holds_travel(int) const override { return true; }
  bool holds_turn(int) const override { return true; }
};

}  // namespace

const Joint& free_root() {
  static const FreeRoot joint;
  return joint;
}

const Joint& fixed_root() {
  static const FixedRoot joint;
  return joint;
}

}  // namespace rubble
