#include "kernel/world/phases/trees.h"

#include <algorithm>
#include <cmath>

#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/link_motions.h"

namespace rubble {
namespace {

constexpr int kTreesPerTask = 4;  // fewer are not worth a thread's start

Pose scaled(const Pose& pose, double scale) { return {pose.rotation, pose.translation * scale}; }

// A joint between two links that hang together already.
void add_loop(const JointType& joint, double scale, const Pose& assembly_from_joint,
              const std::vector<Pose>& assembly_from_com, Tree& tree) {
  TreeLoop loop;
  loop.link_a = joint.parent;
  loop.link_b = joint.child;
  loop.mobility = mobility_of(joint.kind);
  loop.a_from_joint = assembly_from_com[std::size_t(joint.parent)].inverse() * assembly_from_joint;
  loop.b_from_joint = assembly_from_com[std::size_t(joint.child)].inverse() * assembly_from_joint;
  loop.break_force = joint.break_force * (scale * scale);
  loop.break_torque = joint.break_torque * (scale * scale * scale);
  loop.collide = joint.collide;
  tree.loops.push_back(loop);
}

}  // namespace

void WorldTrees::add_assembly(const NewPiece& piece) {
  start(make(types_.assemblies[std::size_t(piece.placement.kind.index)], piece), piece, {});
}

Tree WorldTrees::make(const AssemblyType& assembly, const NewPiece& piece) {
  const double scale = piece.placement.scale;
  const int first = int(data_.bodies.size()), number = int(data_.trees.size());
  Tree tree;
  std::vector<Pose> assembly_from_com;
  for (std::size_t i = 0; i < assembly.links.size(); ++i) {
    const AssemblyLink& design = assembly.links[i];
    const Pose assembly_from_link = scaled(design.assembly_from_link, scale);
    NewPiece part = piece;
    part.placement.kind = design.type;
    part.placement.scale = scale * design.scale;
    part.placement.world_from_body = piece.placement.world_from_body * assembly_from_link;
    part.placement.fixed = piece.placement.fixed && i == 0;
    FreeBody unused;
    bodies_.add(part, &unused);
    Body& body = data_.bodies.back();
    body.tree = number;
    body.link = std::int32_t(i);
    tree.mass += body.mass;
    TreeLink link;
    link.body = first + int(i);
    link.mobility = part.placement.fixed ? Mobility::fixed : Mobility::free;
    tree.links.push_back(link);
    assembly_from_com.push_back(assembly_from_link * Pose{{}, body.com_in_type});
  }
  for (const JointType& joint : assembly.joints) {
    TreeLink& link = tree.links[std::size_t(joint.child)];
    const Pose frame = scaled(joint.assembly_from_joint, scale);
    if (link.parent >= 0) {
      add_loop(joint, scale, frame, assembly_from_com, tree);
      continue;
    }
    link.parent = joint.parent;
    link.parent_from_joint = assembly_from_com[std::size_t(joint.parent)].inverse() * frame;
    link.link_from_joint = assembly_from_com[std::size_t(joint.child)].inverse() * frame;
    link.mobility = mobility_of(joint.kind);
    joint_of(link.mobility).set_figures(joint, scale, link);
  }
  number_coordinates(tree);
  tree.root = data_.bodies[first].world_from_com;
  return tree;
}

void WorldTrees::start(const Tree& tree, const NewPiece& piece, const std::vector<double>& joint_positions) {
  TreeState state;
  state.q.assign(std::size_t(tree.q_count), 0);
  state.u.assign(std::size_t(tree.u_count), 0);
  std::size_t next = 0;
  for (const TreeLink& link : tree.links) {
    if (coordinate_count(link.mobility) >= 4) state.q[std::size_t(link.first_q)] = 1;
    if (coordinate_count(link.mobility) == 1 && next < joint_positions.size()) {
      state.q[std::size_t(link.first_q)] = joint_positions[next++];
    }
  }
  if (!tree.has_fixed_root()) {
    const Quat& r = tree.root.rotation;
    const Vec3 &p = tree.root.translation, &w = piece.angular_velocity, &v = piece.linear_velocity;
    const double pose[7] = {r.w, r.x, r.y, r.z, p.x, p.y, p.z};
    std::copy(pose, pose + 7, state.q.begin());
    const double speeds[6] = {w.x, w.y, w.z, v.x, v.y, v.z};
    std::copy(speeds, speeds + 6, state.u.begin());
  }
  const int number = int(data_.trees.size());
  data_.trees.push_back(tree);
  simbody_.add(tree, data_.bodies, state);
  mirror_state(number);
  for (const TreeLink& link : tree.links) {  // starts from where its joints put it, to the last bit
    Body& body = data_.bodies[link.body];
    body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
    body.touching = body.has_touched = tree.has_fixed_root() && body.mass > 0;
  }
}

bool WorldTrees::is_awake(const Tree& tree) const {
  for (const TreeLink& link : tree.links) {
    if (data_.bodies[link.body].awake) return true;
  }
  return false;
}

void WorldTrees::begin(const StepPairs& step) {
  awake_.clear();
  solved_.trees.clear();
  solved_.motions = &motions_;
  is_solved_.assign(data_.trees.size(), 0);
  motions_.resize(data_.trees.size());
  for (std::size_t i = 0; i < data_.trees.size(); ++i) {
    if (is_awake(data_.trees[i])) awake_.push_back(std::int32_t(i));
  }
  if (awake_.empty()) return;
  pool_.run(int(awake_.size()), kTreesPerTask, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int tree = awake_[i];
      motions_[tree].begin(data_.trees[tree], simbody_.at(tree), settings_.options.gravity,
                           settings_.options.step);
    }
  });
  for (std::int32_t index : step.active) {
    if (!data_.pairs[index].live) continue;
    for (std::int32_t body : {data_.contacts[index].body_a, data_.contacts[index].body_b}) {
      if (body != kGround && data_.bodies[body].tree >= 0) is_solved_[data_.bodies[body].tree] = 1;
    }
  }
  for (std::int32_t tree : awake_) {
    const bool asks = motions_[tree].has_rows() || motions_[tree].near_stop();
    if (asks) is_solved_[tree] = 1;
    if (is_solved_[tree]) solved_.trees.push_back(tree);
  }
}

void WorldTrees::note_touching(const StepPairs& step) {
  if (awake_.empty()) return;
  for (std::int32_t tree : awake_) motions_[tree].touching = false;
  for (std::int32_t index : step.active) {
    const Contact& contact = data_.contacts[index];
    const int a = data_.bodies[contact.body_a].tree;
    const int b = contact.body_b == kGround ? -1 : data_.bodies[contact.body_b].tree;
    if (contact.pressed <= 0 || a == b) continue;
    for (int tree : {a, b}) {
      if (tree >= 0) motions_[tree].touching = true;
    }
  }
  for (std::int32_t tree : awake_) {
    if (!motions_[tree].touching && !data_.trees[tree].has_fixed_root()) continue;
    for (const TreeLink& link : data_.trees[tree].links) {
      Body& body = data_.bodies[link.body];
      if (body.awake) body.touching = body.has_touched = true;
    }
  }
}

void WorldTrees::advance() {
  pool_.run(int(awake_.size()), kTreesPerTask, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int tree = awake_[i];
      TreeMotion& motion = motions_[tree];
      if (is_solved_[tree] && motion.impelled) {
        motion.finish();
      } else {
        if (is_solved_[tree]) motion.begin_again();
        motion.move_freely();
      }
      motion.note_loads();
      mirror_tree(tree, motion);
    }
  });
}

void WorldTrees::mirror_link(TreeLink& link, const Pose& to) {
  Body& body = data_.bodies[link.body];
  const Quat turn = body.world_from_com.rotation.conjugate() * to.rotation;
  body.travel += distance(body.world_from_com.translation, to.translation) +
                 2 * norm(Vec3{turn.x, turn.y, turn.z}) * double(body.radius);
  body.world_from_com = to;
  body.linear = Vec3f(link.linear);
  body.angular = Vec3f(link.angular);
  bodies_.refresh(body);
}

void WorldTrees::mirror_tree(int tree, const TreeMotion& motion) {
  std::vector<TreeLink>& links = data_.trees[tree].links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].mobility == Mobility::fixed) continue;
    links[i].linear = motion.linear_velocity(i);
    links[i].angular = motion.angular_velocity(i);
    mirror_link(links[i], motion.world_from_links()[i]);
  }
}

void WorldTrees::mirror_state(int tree) {
  std::vector<TreeLink>& links = data_.trees[tree].links;
  SimbodyTree& simbody = simbody_.at(tree);
  const TreePose& pose = simbody.pose();
  std::vector<Spatial> motions;
  std::vector<Pose> poses;
  calc_motions(data_.trees[tree], pose, simbody.state().u, motions);
  simbody.calc_world_from_links(poses);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].mobility == Mobility::fixed) continue;
    links[i].linear = pose.links[i].centre_velocity(motions[i]);
    links[i].angular = motions[i].angular();
    mirror_link(links[i], poses[i]);
  }
}

void WorldTrees::keep_whole(std::vector<std::uint8_t>& slept) const {
  for (std::int32_t tree : awake_) {
    bool all = !data_.trees[tree].driven;
    for (const TreeLink& link : data_.trees[tree].links) {
      all = all && (slept[link.body] || !data_.bodies[link.body].movable());
    }
    for (const TreeLink& link : data_.trees[tree].links) {
      if (!all) slept[link.body] = 0;
    }
  }
}

void WorldTrees::stop(int tree) {
  TreeState state = simbody_.state(tree);
  std::fill(state.u.begin(), state.u.end(), 0.0);
  simbody_.set_state(tree, state);
  for (TreeLink& link : data_.trees[tree].links) link.linear = link.angular = {};
}

void WorldTrees::set_motion(int index, const Vec3& linear, const Vec3& angular) {
  const int tree = data_.bodies[index].tree;
  const Tree& t = data_.trees[tree];
  if (t.has_fixed_root()) return;
  const Vec3 arm =
      data_.bodies[t.links[0].body].world_from_com.translation - data_.bodies[index].world_from_com.translation;
  const Vec3 v = linear + cross(angular, arm);
  TreeState state = simbody_.state(tree);
  std::fill(state.u.begin(), state.u.end(), 0.0);
  for (int i = 0; i < 3; ++i) {
    state.u[std::size_t(i)] = angular[i];
    state.u[std::size_t(3 + i)] = v[i];
  }
  simbody_.set_state(tree, state);
  mirror_state(tree);
}

void WorldTrees::apply_impulse(int index, const Vec3& point, const Vec3& impulse) {
  const Body& body = data_.bodies[index];
  const Tree& tree = data_.trees[body.tree];
  SimbodyTree& simbody = simbody_.at(body.tree);
  const TreePose& pose = simbody.pose();
  ArticulatedInertia inertia;
  inertia.factor(tree, pose, std::vector<double>(tree.links.size()));
  TreeState state = simbody.state();
  std::vector<Spatial> motions;
  calc_motions(tree, pose, state.u, motions);
  LinkMotions changed;
  changed.begin(inertia, motions);
  changed.focus_on(body.link);
  changed.apply(force_at(point - pose.reference, impulse));
  changed.settle();
  for (std::size_t i = 0; i < motions.size(); ++i) motions[i] = changed.motion(std::int32_t(i));
  calc_speeds(tree, pose, motions, state.u);
  simbody.set_state(state);
  mirror_state(body.tree);
}

Mat3 WorldTrees::impulse_response(int index, const Vec3& point) const {
  const Body& body = data_.bodies[index];
  const Tree& tree = data_.trees[body.tree];
  const TreePose& pose = simbody_.at(body.tree).pose();
  ArticulatedInertia inertia;
  inertia.factor(tree, pose, std::vector<double>(tree.links.size()));
  const Vec3 arm = point - pose.reference;
  Mat3 response;
  for (int k = 0; k < 3; ++k) {
    Vec3 unit;
    unit[k] = 1;
    const Spatial change = inertia.response(body.link) * force_at(arm, unit);
    const Vec3 gained = change.linear() + cross(change.angular(), arm);
    for (int row = 0; row < 3; ++row) response.rows[row][k] = gained[row];
  }
  return response;
}

void WorldTrees::set_pose(int index, const Pose& world_from_com) {
  const int tree = data_.bodies[index].tree;
  const Tree& t = data_.trees[tree];
  if (t.has_fixed_root()) return;
  const Pose& root = data_.bodies[t.links[0].body].world_from_com;
  const Pose to = world_from_com * (data_.bodies[index].world_from_com.inverse() * root);
  const Quat r = normalized(to.rotation);
  TreeState state = simbody_.state(tree);
  const double q[7] = {r.w, r.x, r.y, r.z, to.translation.x, to.translation.y, to.translation.z};
  std::copy(q, q + 7, state.q.begin());
  simbody_.set_state(tree, state);
  mirror_state(tree);
}

std::vector<std::int32_t> WorldTrees::dissolve(int tree) {
  std::vector<std::int32_t> bodies;
  for (const TreeLink& link : data_.trees[tree].links) bodies.push_back(link.body);
  replace(tree, {}, {});
  for (const std::int32_t body : bodies) data_.bodies[body].tree = data_.bodies[body].link = -1;
  return bodies;
}

void WorldTrees::replace(int tree, const Tree& by, const TreeState& state) {
  data_.trees[tree] = by;
  simbody_.replace(tree, by, data_.bodies, state);
}

}  // namespace rubble
