// Turns about Z of the joint's frame. q: the angle; u: its rate.
#include "kernel/base/portable_math.h"
#include "kernel/multibody/joints/mobilizer.h"
#include "kernel/multibody/joints/single.h"

namespace rubble {
namespace {

#ifndef RUBBLE_WITHOUT_SIMBODY
// Simbody's Pin takes sine and cosine from libm, whose last bits depend on the processor.
class PortablePin : public SimTK::MobilizedBody::Custom::Implementation {
 public:
  explicit PortablePin(SimTK::SimbodyMatterSubsystem& matter) : Implementation(matter, 1, 1, 0) {}
  Implementation* clone() const override { return new PortablePin(*this); }
  SimTK::Transform calcMobilizerTransformFromQ(const SimTK::State&, int,
                                               const SimTK::Real* q) const override {
    const auto [s, c] = portable::sincos(q[0]);
    return SimTK::Transform(SimTK::Rotation(SimTK::Mat33(c, -s, 0, s, c, 0, 0, 0, 1), true));
  }
  SimTK::SpatialVec multiplyByHMatrix(const SimTK::State&, int,
                                      const SimTK::Real* u) const override {
    return {SimTK::Vec3(0, 0, u[0]), SimTK::Vec3(0)};
  }
  void multiplyByHTranspose(const SimTK::State&, const SimTK::SpatialVec& force, int,
                            SimTK::Real* f) const override {
    f[0] = force[0][2];
  }
  SimTK::SpatialVec multiplyByHDotMatrix(const SimTK::State&, int,
                                         const SimTK::Real*) const override {
    return {SimTK::Vec3(0), SimTK::Vec3(0)};
  }
  void multiplyByHDotTranspose(const SimTK::State&, const SimTK::SpatialVec&, int,
                               SimTK::Real* f) const override {
    f[0] = 0;
  }
};
#endif

class Hinge : public SingleJoint {
 public:
#ifndef RUBBLE_WITHOUT_SIMBODY
  void mobilize(MobilizerPlace& p) const override {
    p.made = SimTK::MobilizedBody::Custom(
        p.parent, new PortablePin(p.parent.updMatterSubsystem()), p.in_parent, p.body, p.in_link);
  }
#endif
  bool holds_travel(int) const override { return true; }
  bool holds_turn(int axis) const override { return axis != 2; }
};

}  // namespace

const Joint& hinge_joint() {
  static const Hinge joint;
  return joint;
}

}  // namespace rubble
