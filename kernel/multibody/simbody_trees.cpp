#include "kernel/multibody/simbody_trees.h"

#include <utility>

#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/joints/mobilizer.h"

namespace rubble {
namespace {

SimTK::Vec3 to_simbody(const Vec3& v) { return {v.x, v.y, v.z}; }
Vec3 from_simbody(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

SimTK::Transform to_simbody(const Pose& pose) {
  const Mat3 m = pose.rotation.matrix();
  const auto& r = m.rows;
  const SimTK::Mat33 rotation(r[0].x, r[0].y, r[0].z, r[1].x, r[1].y, r[1].z, r[2].x, r[2].y,
                              r[2].z);
  return {SimTK::Rotation(rotation, true), to_simbody(pose.translation)};
}

SimTK::Body::Rigid to_simbody(const Body& body) {
  const auto& r = body.inertia.rows;
  return SimTK::Body::Rigid(SimTK::MassProperties(
      body.mass, SimTK::Vec3(0),
      SimTK::Inertia(SimTK::Vec3(r[0].x, r[1].y, r[2].z), SimTK::Vec3(r[0].y, r[0].z, r[1].z))));
}

}  // namespace

struct SimbodyTree::System {
  explicit System(const Tree& source) : tree(source), matter(system) {}
  void add_links(const std::vector<Body>& masses);
  void number();
  void read_pose(std::size_t link);

  Tree tree;
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  std::vector<SimTK::MobilizedBody> bodies;  // by link; an immovable root is the Ground
  SimTK::State state;
  std::vector<int> q_of, u_of;  // where Simbody has each coordinate and speed of ours
  TreePose pose;
  bool has_pose = false;
  // Scratch.
  SimTK::Vector none, in, out;
  SimTK::Vector_<SimTK::SpatialVec> weights;
};

void SimbodyTree::System::add_links(const std::vector<Body>& masses) {
  for (const TreeLink& link : tree.links) {
    const Body& body = masses[std::size_t(link.body)];
    MobilizerPlace place;
    place.parent = link.parent < 0 ? matter.updGround() : bodies[std::size_t(link.parent)];
    Pose in_parent = link.parent_from_joint;
    if (link.parent >= 0 && tree.links[std::size_t(link.parent)].mobility == Mobility::fixed) {
      in_parent = tree.root * in_parent;
    }
    place.in_parent = to_simbody(in_parent);
    place.in_link = to_simbody(link.link_from_joint);
    if (body.mass > 0) place.body = to_simbody(body);
    joint_of(link.mobility).mobilize(place);
    bodies.push_back(place.made);
  }
}

void SimbodyTree::System::number() {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const TreeLink& link = tree.links[i];
    if (link.mobility == Mobility::fixed) continue;
    const SimTK::MobilizedBody& body = bodies[i];
    const int q = int(body.getFirstQIndex(state)), u = int(body.getFirstUIndex(state));
    const int turns = link.mobility == Mobility::free ? 4 : coordinate_count(link.mobility);
    const int spins = link.mobility == Mobility::free ? 3 : speed_count(link.mobility);
    for (int k = 0; k < turns; ++k) q_of.push_back(q + k);
    for (int k = 0; k < spins; ++k) u_of.push_back(u + k);
    if (link.mobility != Mobility::free) continue;
    const SimTK::MobilizedBody& carrier = body.getParentMobilizedBody();
    for (int k = 0; k < 3; ++k) {
      q_of.push_back(int(carrier.getFirstQIndex(state)) + k);
      u_of.push_back(int(carrier.getFirstUIndex(state)) + k);
    }
  }
}

SimbodyTree::SimbodyTree(const Tree& tree, const std::vector<Body>& bodies)
    : system_(std::make_unique<System>(tree)) {
  System& s = *system_;
  s.add_links(bodies);
  s.state = s.system.realizeTopology();
  s.system.realizeModel(s.state);
  s.number();
  s.none.resize(s.state.getNU());
  s.none.setToZero();
  s.in = s.out = s.none;
  s.weights.resize(s.matter.getNumBodies());
  s.weights.setToZero();
  s.pose.links.resize(tree.links.size());
  s.pose.axes.resize(std::size_t(tree.u_count));
  s.pose.duals.resize(std::size_t(tree.u_count));
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    s.pose.links[i].mass = bodies[std::size_t(tree.links[i].body)].mass;
  }
}

SimbodyTree::~SimbodyTree() = default;

TreeState SimbodyTree::state() const {
  const System& s = *system_;
  TreeState result;
  if (s.u_of.empty()) return result;
  const double* q = s.state.getQ().getContiguousScalarData();
  const double* u = s.state.getU().getContiguousScalarData();
  for (int at : s.q_of) result.q.push_back(q[at]);
  for (int at : s.u_of) result.u.push_back(u[at]);
  return result;
}

void SimbodyTree::set_state(const TreeState& from) {
  System& s = *system_;
  if (s.u_of.empty()) return;
  double* q = s.state.updQ().updContiguousScalarData();
  for (std::size_t k = 0; k < from.q.size(); ++k) q[s.q_of[k]] = from.q[k];
  set_speeds(from.u);
  s.has_pose = false;
}

void SimbodyTree::set_speeds(const std::vector<double>& from) {
  System& s = *system_;
  if (s.u_of.empty()) return;
  double* u = s.state.updU().updContiguousScalarData();
  for (std::size_t k = 0; k < from.size(); ++k) u[s.u_of[k]] = from[k];
}

void SimbodyTree::System::read_pose(std::size_t index) {
  const TreeLink& link = tree.links[index];
  LinkPose& to = pose.links[index];
  if (link.mobility == Mobility::fixed) {
    to.centre = tree.root.translation - pose.reference;
    return;
  }
  const SimTK::MobilizedBody& body = bodies[index];
  to.centre = from_simbody(body.getBodyTransform(state).p()) - pose.reference;
  const SimTK::SpatialInertia& inertia = body.getBodySpatialInertiaInGround(state);
  const SimTK::Mat33 turns = inertia.getUnitInertia().toMat33();
  for (int i = 0; i < 3; ++i) {
    to.inertia.rows[i] = Vec3{turns(i, 0), turns(i, 1), turns(i, 2)} * to.mass;
  }
  if (link.parent < 0) return;
  for (int k = 0; k < speed_count(link.mobility); ++k) {
    const SimTK::SpatialVec column = body.getHCol(state, SimTK::MobilizerUIndex(k));
    const Vec3 turn = from_simbody(column[0]), shift = from_simbody(column[1]);
    const std::size_t at = std::size_t(link.first_u + k);
    pose.axes[at] = {turn, shift + cross(to.centre, turn)};
    const bool slides = link.mobility == Mobility::slider;
    pose.duals[at] = slides ? Spatial{{}, shift} : Spatial{turn, {}};
  }
}

const TreePose& SimbodyTree::pose() {
  System& s = *system_;
  if (s.has_pose) return s.pose;
  s.system.realize(s.state, SimTK::Stage::Position);
  s.pose.reference = s.tree.has_fixed_root()
                         ? s.tree.root.translation
                         : from_simbody(s.bodies[0].getBodyTransform(s.state).p());
  for (std::size_t i = 0; i < s.bodies.size(); ++i) s.read_pose(i);
  s.has_pose = true;
  return s.pose;
}

void SimbodyTree::calc_world_from_links(std::vector<Pose>& poses) {
  System& s = *system_;
  s.system.realize(s.state, SimTK::Stage::Position);
  poses.resize(s.bodies.size());
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    if (s.tree.links[i].mobility == Mobility::fixed) {
      poses[i] = s.tree.root;
      continue;
    }
    const SimTK::Transform& x = s.bodies[i].getBodyTransform(s.state);
    const SimTK::Quaternion q = x.R().convertRotationToQuaternion();
    poses[i] = {normalized(Quat{q[0], q[1], q[2], q[3]}), from_simbody(x.p())};
  }
}

void SimbodyTree::calc_forces(double gravity, std::vector<double>& forces) {
  System& s = *system_;
  forces.resize(s.u_of.size());
  if (s.u_of.empty()) return;
  s.system.realize(s.state, SimTK::Stage::Velocity);
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    if (s.tree.links[i].mobility == Mobility::fixed) continue;
    const double weight = gravity * s.pose.links[i].mass;
    s.weights[int(s.bodies[i].getMobilizedBodyIndex())][1] = SimTK::Vec3(0, 0, -weight);
  }
  // M 0 + C - J^T w
  s.matter.calcResidualForceIgnoringConstraints(s.state, s.none, s.weights, s.none, s.out);
  const double* residual = s.out.getContiguousScalarData();
  for (std::size_t k = 0; k < s.u_of.size(); ++k) forces[k] = -residual[s.u_of[k]];
}

void SimbodyTree::multiply_by_inverse_mass(const std::vector<double>& forces,
                                           std::vector<double>& accelerations) {
  System& s = *system_;
  accelerations.resize(s.u_of.size());
  if (s.u_of.empty()) return;
  s.system.realize(s.state, SimTK::Stage::Position);
  double* in = s.in.updContiguousScalarData();
  for (std::size_t k = 0; k < s.u_of.size(); ++k) in[s.u_of[k]] = forces[k];
  s.matter.multiplyByMInv(s.state, s.in, s.out);
  const double* out = s.out.getContiguousScalarData();
  for (std::size_t k = 0; k < s.u_of.size(); ++k) accelerations[k] = out[s.u_of[k]];
}

int SimbodyTrees::add(const Tree& tree, const std::vector<Body>& bodies, const TreeState& state) {
  trees_.emplace_back();
  replace(size() - 1, tree, bodies, state);
  return size() - 1;
}

void SimbodyTrees::replace(int index, const Tree& tree, const std::vector<Body>& bodies,
                           const TreeState& state) {
  auto& place = trees_[std::size_t(index)];
  place.reset();
  if (tree.links.empty()) return;
  place = std::make_unique<SimbodyTree>(tree, bodies);
  place->set_state(state);
}

TreeState SimbodyTrees::state(int index) const {
  const auto& tree = trees_[std::size_t(index)];
  return tree ? tree->state() : TreeState{};
}

}  // namespace rubble
