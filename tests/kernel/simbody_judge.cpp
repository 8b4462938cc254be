#include "simbody_judge.h"

#include <Simbody.h>

namespace rubble::testing {
namespace {

SimTK::Transform to_simbody(const Pose& pose) {
  const Quat& r = pose.rotation;
  const Vec3& p = pose.translation;
  return {SimTK::Rotation(SimTK::Quaternion(r.w, r.x, r.y, r.z)), SimTK::Vec3(p.x, p.y, p.z)};
}

class Judge {
 public:
  Judge(const Tree& tree, const std::vector<Body>& bodies, const TreeState& from, double gravity)
      : tree_(tree), matter_(system_), forces_(system_),
        gravity_(forces_, matter_, SimTK::Vec3(0, 0, -gravity)) {
    for (const TreeLink& link : tree.links) add(link, bodies[std::size_t(link.body)]);
    state_ = system_.realizeTopology();
    system_.realizeModel(state_);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const TreeLink& link = tree.links[i];
      for (int k = 0; k < coordinate_count(link.mobility); ++k) {
        links_[i].setOneQ(state_, k, from.q[std::size_t(link.first_q + k)]);
      }
      for (int k = 0; k < speed_count(link.mobility); ++k) {
        links_[i].setOneU(state_, k, from.u[std::size_t(link.first_u + k)]);
      }
    }
  }

  std::vector<Pose> integrate(double seconds) {
    SimTK::RungeKuttaMersonIntegrator integrator(system_);
    integrator.setAccuracy(1e-10);
    SimTK::TimeStepper stepper(system_, integrator);
    stepper.initialize(state_);
    stepper.stepTo(seconds);
    std::vector<Pose> poses;
    for (const SimTK::MobilizedBody& link : links_) {
      const SimTK::Transform& x = link.getBodyTransform(integrator.getState());
      const SimTK::Quaternion q = x.R().convertRotationToQuaternion();
      poses.push_back({{q[0], q[1], q[2], q[3]}, {x.p()[0], x.p()[1], x.p()[2]}});
    }
    return poses;
  }

  std::vector<double> accelerate() {
    system_.realize(state_, SimTK::Stage::Acceleration);
    std::vector<double> result;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      for (int k = 0; k < speed_count(tree_.links[i].mobility); ++k) {
        result.push_back(links_[i].getOneUDot(state_, k));
      }
    }
    return result;
  }

 private:
  void add(const TreeLink& link, const Body& body) {
    const auto& r = body.inertia.rows;
    const SimTK::Body::Rigid rigid(
        body.mass > 0 ? SimTK::MassProperties(
                            body.mass, SimTK::Vec3(0),
                            SimTK::Inertia(r[0].x, r[1].y, r[2].z, r[0].y, r[0].z, r[1].z))
                      : SimTK::MassProperties(1, SimTK::Vec3(0), SimTK::Inertia(1)));
    SimTK::MobilizedBody& parent =
        link.parent < 0 ? matter_.updGround() : links_[std::size_t(link.parent)];
    const SimTK::Transform in_parent = to_simbody(
        link.mobility == Mobility::fixed ? tree_.root : link.parent_from_joint);
    const SimTK::Transform in_link = to_simbody(link.link_from_joint);
    switch (link.mobility) {
      case Mobility::free:
        links_.push_back(SimTK::MobilizedBody::Free(parent, in_parent, rigid, in_link));
        break;
      case Mobility::fixed:
      case Mobility::weld:
        links_.push_back(SimTK::MobilizedBody::Weld(parent, in_parent, rigid, in_link));
        break;
      case Mobility::hinge:
        links_.push_back(SimTK::MobilizedBody::Pin(parent, in_parent, rigid, in_link));
        break;
      case Mobility::slider:
        links_.push_back(SimTK::MobilizedBody::Slider(parent, in_parent, rigid, in_link));
        break;
      case Mobility::ball:
        links_.push_back(SimTK::MobilizedBody::Ball(parent, in_parent, rigid, in_link));
        break;
    }
  }

  Tree tree_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Force::Gravity gravity_;
  std::vector<SimTK::MobilizedBody> links_;
  SimTK::State state_;
};

}  // namespace

std::vector<Pose> integrate_with_simbody(const Tree& tree, const std::vector<Body>& bodies,
                                         const TreeState& state, double gravity, double seconds) {
  return Judge(tree, bodies, state, gravity).integrate(seconds);
}

std::vector<double> accelerate_with_simbody(const Tree& tree, const std::vector<Body>& bodies,
                                            const TreeState& state, double gravity) {
  return Judge(tree, bodies, state, gravity).accelerate();
}

}  // namespace rubble::testing
