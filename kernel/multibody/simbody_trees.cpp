#include "kernel/multibody/simbody_trees.h"

#include <Simbody.h>

#include <utility>

namespace rubble {
namespace {

SimTK::Vec3 to_simbody(const Vec3& v) { return {v.x, v.y, v.z}; }

SimTK::Transform to_simbody(const Pose& pose) {
  const Mat3 m = pose.rotation.matrix();
  const auto& r = m.rows;
  const SimTK::Mat33 rotation(r[0].x, r[0].y, r[0].z, r[1].x, r[1].y, r[1].z, r[2].x, r[2].y,
                              r[2].z);
  return {SimTK::Rotation(rotation, true), to_simbody(pose.translation)};
}

SimTK::Body::Rigid to_simbody(const Body& body) {
  if (body.mass <= 0) {
    return SimTK::Body::Rigid(SimTK::MassProperties(1, SimTK::Vec3(0), SimTK::Inertia(1)));
  }
  const auto& r = body.inertia.rows;
  return SimTK::Body::Rigid(SimTK::MassProperties(
      body.mass, SimTK::Vec3(0),
      SimTK::Inertia(SimTK::Vec3(r[0].x, r[1].y, r[2].z), SimTK::Vec3(r[0].y, r[0].z, r[1].z))));
}

SimTK::MobilizedBody join(SimTK::MobilizedBody& parent, const TreeLink& link,
                          const SimTK::Body::Rigid& body) {
  const SimTK::Transform in_parent = to_simbody(link.parent_from_joint),
                         in_link = to_simbody(link.link_from_joint);
  switch (link.mobility) {
    case Mobility::free:
      return SimTK::MobilizedBody::Free(parent, in_parent, body, in_link);
    case Mobility::hinge:
      return SimTK::MobilizedBody::Pin(parent, in_parent, body, in_link);
    case Mobility::slider:
      return SimTK::MobilizedBody::Slider(parent, in_parent, body, in_link);
    case Mobility::ball:
      return SimTK::MobilizedBody::Ball(parent, in_parent, body, in_link);
    default:
      return SimTK::MobilizedBody::Weld(parent, in_parent, body, in_link);
  }
}

}  // namespace

struct SimbodyTrees::System {
  System(const Tree& source, const std::vector<Body>& masses) : tree(source), matter(system) {
    for (const TreeLink& link : tree.links) {
      TreeLink placed = link;
      if (link.mobility == Mobility::fixed) placed.parent_from_joint = tree.root;
      SimTK::MobilizedBody& parent =
          link.parent < 0 ? matter.updGround() : bodies[std::size_t(link.parent)];
      bodies.push_back(join(parent, placed, to_simbody(masses[std::size_t(link.body)])));
    }
    state = system.realizeTopology();
    system.realizeModel(state);
  }

  Tree tree;
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  std::vector<SimTK::MobilizedBody> bodies;
  SimTK::State state;
};

SimbodyTrees::SimbodyTrees() = default;
SimbodyTrees::~SimbodyTrees() = default;
SimbodyTrees::SimbodyTrees(SimbodyTrees&&) noexcept = default;
SimbodyTrees& SimbodyTrees::operator=(SimbodyTrees&&) noexcept = default;

int SimbodyTrees::add(const Tree& tree, const std::vector<Body>& bodies, const TreeState& state) {
  systems_.emplace_back();
  replace(size() - 1, tree, bodies, state);
  return size() - 1;
}

void SimbodyTrees::replace(int index, const Tree& tree, const std::vector<Body>& bodies,
                           const TreeState& state) {
  auto& system = systems_[std::size_t(index)];
  system.reset();
  if (tree.links.empty()) return;
  system = std::make_unique<System>(tree, bodies);
  set_state(index, state);
}

TreeState SimbodyTrees::state(int index) const {
  TreeState result;
  if (!systems_[std::size_t(index)]) return result;
  const System& s = *systems_[std::size_t(index)];
  result.q.resize(std::size_t(s.tree.q_count));
  result.u.resize(std::size_t(s.tree.u_count));
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    const TreeLink& link = s.tree.links[i];
    const int q = int(s.bodies[i].getFirstQIndex(s.state)),
              u = int(s.bodies[i].getFirstUIndex(s.state));
    for (int k = 0; k < coordinate_count(link.mobility); ++k) {
      result.q[std::size_t(link.first_q + k)] = s.state.getQ()[q + k];
    }
    for (int k = 0; k < speed_count(link.mobility); ++k) {
      result.u[std::size_t(link.first_u + k)] = s.state.getU()[u + k];
    }
  }
  return result;
}

void SimbodyTrees::set_state(int index, const TreeState& from) {
  System& s = *systems_[std::size_t(index)];
  SimTK::Vector &all_q = s.state.updQ(), &all_u = s.state.updU();
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    const TreeLink& link = s.tree.links[i];
    const int q = int(s.bodies[i].getFirstQIndex(s.state)),
              u = int(s.bodies[i].getFirstUIndex(s.state));
    for (int k = 0; k < coordinate_count(link.mobility); ++k) {
      all_q[q + k] = from.q[std::size_t(link.first_q + k)];
    }
    for (int k = 0; k < speed_count(link.mobility); ++k) {
      all_u[u + k] = from.u[std::size_t(link.first_u + k)];
    }
  }
}

Pose SimbodyTrees::calc_simbody_pose(int index, int link) const {
  const System& s = *systems_[std::size_t(index)];
  SimTK::State state = s.state;
  s.system.realize(state, SimTK::Stage::Position);
  const SimTK::Transform& x = s.bodies[std::size_t(link)].getBodyTransform(state);
  const SimTK::Quaternion q = x.R().convertRotationToQuaternion();
  return {{q[0], q[1], q[2], q[3]}, {x.p()[0], x.p()[1], x.p()[2]}};
}

std::vector<double> SimbodyTrees::calc_simbody_accelerations(int index, double gravity) const {
  const System& s = *systems_[std::size_t(index)];
  SimTK::State state = s.state;
  s.system.realize(state, SimTK::Stage::Dynamics);
  SimTK::Vector_<SimTK::SpatialVec> forces(int(s.bodies.size()) + 1,
                                           SimTK::SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0)));
  for (const SimTK::MobilizedBody& body : s.bodies) {
    const double weight = gravity * body.getBodyMass(state);
    forces[int(body.getMobilizedBodyIndex())][1] = SimTK::Vec3(0, 0, -weight);
  }
  const SimTK::Vector none(state.getNU(), 0.0);
  SimTK::Vector accelerations;
  SimTK::Vector_<SimTK::SpatialVec> of_bodies;
  s.matter.calcAcceleration(state, none, forces, accelerations, of_bodies);
  std::vector<double> result(std::size_t(s.tree.u_count));
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    const TreeLink& link = s.tree.links[i];
    const int u = int(s.bodies[i].getFirstUIndex(s.state));
    for (int k = 0; k < speed_count(link.mobility); ++k) {
      result[std::size_t(link.first_u + k)] = accelerations[u + k];
    }
  }
  return result;
}

}  // namespace rubble
