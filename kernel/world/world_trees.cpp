// Articulated trees in the world: made from assemblies, moved once a step, asleep or awake as a
// whole.
#include <algorithm>
#include <cmath>

#include "kernel/multibody/tree_joint.h"
#include "kernel/solver/speed_limits.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

constexpr int kTreesPerTask = 4;

Mobility mobility_of(JointKind kind) {
  switch (kind) {
    case JointKind::weld:
      return Mobility::weld;
    case JointKind::hinge:
      return Mobility::hinge;
    case JointKind::slider:
      return Mobility::slider;
    default:
      return Mobility::ball;
  }
}

// Figures of a joint at a size; see assembly.h.
void set_joint(const JointType& joint, double s, TreeLink& link) {
  const bool slides = joint.kind == JointKind::slider;
  const double s2 = s * s, s3 = s2 * s;
  link.mobility = mobility_of(joint.kind);
  link.stiffness = joint.stiffness * (slides ? s : s3);
  link.damping = joint.damping * (slides ? s2 : s3 * s);
  link.yield = joint.yield * (slides ? s2 : s3);
  link.break_force = joint.break_force * s2;
  link.break_torque = joint.break_torque * s3;
  link.lower = joint.kind == JointKind::ball ? -kNever : joint.lower * (slides ? s : 1);
  link.upper = joint.upper * (slides ? s : 1);
  link.collide = joint.collide;
}

Pose scaled(const Pose& pose, double scale) { return {pose.rotation, pose.translation * scale}; }

}  // namespace

void World::Impl::add_tree(const NewPiece& piece) {
  const AssemblyType& assembly = assemblies[piece.placement.type - int(types.size())];
  const double scale = piece.placement.scale;
  const int first = int(data.bodies.size()), number = int(data.trees.size());
  Tree tree;
  TreeState state;
  std::vector<Pose> assembly_from_com;
  for (std::size_t i = 0; i < assembly.links.size(); ++i) {
    const AssemblyLink& design = assembly.links[i];
    const Pose assembly_from_link = scaled(design.assembly_from_link, scale);
    NewPiece part = piece;
    part.placement.type = design.type;
    part.placement.scale = scale * design.scale;
    part.placement.world_from_body = piece.placement.world_from_body * assembly_from_link;
    part.placement.fixed = piece.placement.fixed && i == 0;
    FreeBody unused;
    add_body(part, &unused);
    Body& body = data.bodies.back();
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
    link.parent = joint.parent;
    link.parent_from_joint = assembly_from_com[std::size_t(joint.parent)].inverse() * frame;
    link.link_from_joint = assembly_from_com[std::size_t(joint.child)].inverse() * frame;
    set_joint(joint, scale, link);
  }
  number_coordinates(tree);
  tree.root = data.bodies[first].world_from_com;
  state.q.assign(std::size_t(tree.q_count), 0);
  state.u.assign(std::size_t(tree.u_count), 0);
  for (const TreeLink& link : tree.links) {
    if (coordinate_count(link.mobility) >= 4) state.q[std::size_t(link.first_q)] = 1;
  }
  if (!tree.has_fixed_root()) {
    const Quat& r = tree.root.rotation;
    const Vec3 &p = tree.root.translation, &w = piece.angular_velocity, &v = piece.linear_velocity;
    const double pose[7] = {r.w, r.x, r.y, r.z, p.x, p.y, p.z};
    std::copy(pose, pose + 7, state.q.begin());
    const double speeds[6] = {w.x, w.y, w.z, v.x, v.y, v.z};
    std::copy(speeds, speeds + 6, state.u.begin());
  }
  data.trees.push_back(tree);
  simbody_trees.add(tree, data.bodies, state);
  mirror_state(number);
  for (const TreeLink& link : tree.links) {  // starts from where its joints put it, to the last bit
    Body& body = data.bodies[link.body];
    body.still_pose = body.loose_pose = body.world_from_com;
    body.touching = body.has_touched = tree.has_fixed_root() && body.mass > 0;
  }
}

bool World::Impl::are_joined(int body_a, int body_b) const {
  const Body &a = data.bodies[body_a], &b = data.bodies[body_b];
  if (a.tree >= 0 && a.tree == b.tree) {
    const std::vector<TreeLink>& links = data.trees[a.tree].links;
    const TreeLink &one = links[a.link], &other = links[b.link];
    if (one.parent == b.link) return !one.collide;
    if (other.parent == a.link) return !other.collide;
  }
  for (const PartedPair& p : data.parted) {
    if (p.body_a == std::min(body_a, body_b) && p.body_b == std::max(body_a, body_b)) return true;
  }
  return false;
}

bool World::Impl::is_awake(const Tree& tree) const {
  for (const TreeLink& link : tree.links) {
    if (data.bodies[link.body].awake) return true;
  }
  return false;
}

// Takes up the awake trees, and tells the solver which of them it moves.
void World::Impl::begin_trees() {
  awake_trees.clear();
  solved_trees.trees.clear();
  solved_trees.motions = &tree_motions;
  is_solved.assign(data.trees.size(), 0);
  tree_motions.resize(data.trees.size());
  for (std::size_t i = 0; i < data.trees.size(); ++i) {
    if (is_awake(data.trees[i])) awake_trees.push_back(std::int32_t(i));
  }
  if (awake_trees.empty()) return;
  pool.run(int(awake_trees.size()), kTreesPerTask, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int tree = awake_trees[i];
      tree_motions[tree].begin(data.trees[tree], data.bodies, simbody_trees.state(tree),
                               options.gravity, options.step);
    }
  });
  for (std::int32_t index : active) {
    if (!data.pairs[index].live) continue;
    for (std::int32_t body : {data.contacts[index].body_a, data.contacts[index].body_b}) {
      if (body != kGround && data.bodies[body].tree >= 0) is_solved[data.bodies[body].tree] = 1;
    }
  }
  for (std::int32_t tree : awake_trees) {
    if (!is_solved[tree] && tree_motions[tree].near_stop()) is_solved[tree] = 1;
    if (is_solved[tree]) solved_trees.trees.push_back(tree);
  }
}

// What hangs on something that touches is held too.
void World::Impl::touch_trees() {
  if (awake_trees.empty()) return;
  for (std::int32_t tree : awake_trees) tree_motions[tree].touching = false;
  for (std::int32_t index : active) {
    const Contact& contact = data.contacts[index];
    const int a = data.bodies[contact.body_a].tree;
    const int b = contact.body_b == kGround ? -1 : data.bodies[contact.body_b].tree;
    if (contact.pressed <= 0 || a == b) continue;
    for (int tree : {a, b}) {
      if (tree >= 0) tree_motions[tree].touching = true;
    }
  }
  for (std::int32_t tree : awake_trees) {
    if (!tree_motions[tree].touching && !data.trees[tree].has_fixed_root()) continue;
    for (const TreeLink& link : data.trees[tree].links) {
      Body& body = data.bodies[link.body];
      if (body.awake) body.touching = body.has_touched = true;
    }
  }
}

void World::Impl::advance_trees() {
  pool.run(int(awake_trees.size()), kTreesPerTask, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int tree = awake_trees[i];
      TreeMotion& motion = tree_motions[tree];
      if (is_solved[tree]) {
        motion.finish();
      } else {
        motion.move_freely();
      }
      motion.note_loads();
      limit_tree(tree);
      simbody_trees.set_state(tree, motion.state());
      mirror_tree(tree, motion.pose(), motion.motions());
    }
  });
}

// What limit_kicks() and set_rates() do with free pieces, for all speeds of a tree at once.
void World::Impl::limit_tree(int tree) {
  TreeMotion& motion = tree_motions[tree];
  if (!motion.touching) return;
  float spin = 0, speed = 0, keep = 1;
  const auto outwards = [](const Vec3f& v) { return Vec3f{v.x, v.y, std::max(v.z, 0.0F)}; };
  const float fall = float(options.gravity * options.step);
  const std::vector<TreeLink>& links = data.trees[tree].links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Body& body = data.bodies[links[i].body];
    if (!body.awake) continue;
    const Vec3f linear(motion.linear_velocity(i)), angular(motion.angular_velocity(i));
    spin = std::max(spin, norm(angular));
    speed = std::max(speed, norm(linear));
    const float before = norm(outwards(body.linear)), after = norm(outwards(linear));
    const float most = std::max(before + fall, kKickShare * fastest[links[i].body] + kFreeKick);
    if (after > most) keep = std::min(keep, most / after);
  }
  if (spin > kMaximumSpin) keep = std::min(keep, kMaximumSpin / spin);
  if (speed > kMaximumSpeed) keep = std::min(keep, kMaximumSpeed / speed);
  if (spin < kSlowSpin && speed < kSlowSpeed) {
    keep *= 1 - kSpinDamping * (1 - spin / kSlowSpin);
    keep *= 1 - kSpeedDamping * (1 - speed / kSlowSpeed);
  }
  if (keep < 1) motion.slow_down(double(keep));
}

void World::Impl::mirror_tree(int tree, const TreePose& pose, const std::vector<Spatial>& motions) {
  std::vector<TreeLink>& links = data.trees[tree].links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    TreeLink& link = links[i];
    if (link.mobility == Mobility::fixed) continue;
    Body& body = data.bodies[link.body];
    link.linear = calc_com_velocity(pose, i, motions[i]);
    link.angular = motions[i].angular;
    const Pose& to = pose.world_from_com[i];
    const Quat turn = body.world_from_com.rotation.conjugate() * to.rotation;
    body.travel += distance(body.world_from_com.translation, to.translation) +
                   2 * norm(Vec3{turn.x, turn.y, turn.z}) * double(body.radius);
    body.world_from_com = to;
    body.linear = Vec3f(link.linear);
    body.angular = Vec3f(link.angular);
    refresh(body);
  }
}

// The same from what Simbody holds, after it was changed from outside.
void World::Impl::mirror_state(int tree) {
  const TreeState state = simbody_trees.state(tree);
  const Tree& t = data.trees[tree];
  TreePose pose;
  std::vector<Spatial> motions;
  pose.set(t, data.bodies, state.q, data.bodies[t.links[0].body].world_from_com.translation);
  calc_motions(t, pose, state.u, motions);
  mirror_tree(tree, pose, motions);
}

// Nobody falls asleep before all links of its tree do.
void World::Impl::keep_trees_whole() {
  for (std::int32_t tree : awake_trees) {
    bool all = true;
    for (const TreeLink& link : data.trees[tree].links) {
      all = all && (slept[link.body] || !data.bodies[link.body].movable());
    }
    for (const TreeLink& link : data.trees[tree].links) {
      if (!all) slept[link.body] = 0;
    }
  }
}

void World::Impl::stop_tree(int tree) {
  TreeState state = simbody_trees.state(tree);
  std::fill(state.u.begin(), state.u.end(), 0.0);
  simbody_trees.set_state(tree, state);
  for (TreeLink& link : data.trees[tree].links) link.linear = link.angular = {};
}

// A tree of which one link has left the world is lost, except for an immovable root.
void World::Impl::lose_tree(int tree) {
  const std::vector<TreeLink> links = data.trees[tree].links;
  data.trees[tree] = {};
  simbody_trees.replace(tree, {}, data.bodies, {});
  for (const TreeLink& link : links) {
    Body& body = data.bodies[link.body];
    body.tree = body.link = -1;
    if (body.movable()) lose(link.body);
  }
}

void World::Impl::set_tree_motion(int index, const Vec3& linear, const Vec3& angular) {
  const int tree = data.bodies[index].tree;
  const Tree& t = data.trees[tree];
  if (t.has_fixed_root()) return;
  const Vec3 arm = data.bodies[t.links[0].body].world_from_com.translation -
                   data.bodies[index].world_from_com.translation;
  const Vec3 v = linear + cross(angular, arm);
  TreeState state = simbody_trees.state(tree);
  std::fill(state.u.begin(), state.u.end(), 0.0);
  for (int i = 0; i < 3; ++i) {
    state.u[std::size_t(i)] = angular[i];
    state.u[std::size_t(3 + i)] = v[i];
  }
  simbody_trees.set_state(tree, state);
  mirror_state(tree);
}

void World::Impl::set_tree_pose(int index, const Pose& world_from_com) {
  const int tree = data.bodies[index].tree;
  const Tree& t = data.trees[tree];
  if (t.has_fixed_root()) return;
  const Pose& root = data.bodies[t.links[0].body].world_from_com;
  const Pose to = world_from_com * (data.bodies[index].world_from_com.inverse() * root);
  const Quat r = normalized(to.rotation);
  TreeState state = simbody_trees.state(tree);
  const double q[7] = {r.w, r.x, r.y, r.z, to.translation.x, to.translation.y, to.translation.z};
  std::copy(q, q + 7, state.q.begin());
  simbody_trees.set_state(tree, state);
  mirror_state(tree);
}

std::vector<JointState> World::joints() const {
  const Impl& w = *impl_;
  constexpr JointKind kKinds[kMobilities] = {JointKind::weld,  JointKind::weld,   JointKind::weld,
                                             JointKind::hinge, JointKind::slider, JointKind::ball};
  std::vector<JointState> joints;
  for (const Tree& tree : w.data.trees) {
    for (const TreeLink& link : tree.links) {
      if (link.parent < 0) continue;
      JointState joint;
      joint.parent = tree.links[std::size_t(link.parent)].body;
      joint.child = link.body;
      joint.kind = kKinds[int(link.mobility)];
      joint.parent_from_joint =
          Pose{{}, w.data.bodies[joint.parent].com_in_type} * link.parent_from_joint;
      joint.child_from_joint =
          Pose{{}, w.data.bodies[joint.child].com_in_type} * link.link_from_joint;
      joint.rest = link.rest;
      joint.rest_rotation = link.rest_rotation;
      joints.push_back(joint);
    }
  }
  std::sort(joints.begin(), joints.end(), [](const JointState& a, const JointState& b) {
    return a.child < b.child;  // a piece hangs on one other at most
  });
  return joints;
}

}  // namespace rubble
