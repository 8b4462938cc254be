// Articulated trees in the world: made from assemblies, moved once a step, asleep or awake as a
// whole.
#include <algorithm>
#include <cmath>

#include "kernel/multibody/joints/joint.h"
#include "kernel/world/world_impl.h"

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

void World::Impl::add_assembly(const NewPiece& piece) {
  start_tree(make_tree(assemblies[std::size_t(piece.placement.type - placeable_types)], piece), piece,
             {});
}

// Adds the links' bodies and joins them.
Tree World::Impl::make_tree(const AssemblyType& assembly, const NewPiece& piece) {
  const double scale = piece.placement.scale;
  const int first = int(data.bodies.size()), number = int(data.trees.size());
  Tree tree;
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
  tree.root = data.bodies[first].world_from_com;
  return tree;
}

// joint_positions: of the links with a joint of one coordinate, in their order; empty: as designed.
void World::Impl::start_tree(const Tree& tree, const NewPiece& piece,
                             const std::vector<double>& joint_positions) {
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
  const int number = int(data.trees.size());
  data.trees.push_back(tree);
  simbody_trees.add(tree, data.bodies, state);
  mirror_state(number);
  for (const TreeLink& link : tree.links) {  // starts from where its joints put it, to the last bit
    Body& body = data.bodies[link.body];
    body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
    body.touching = body.has_touched = tree.has_fixed_root() && body.mass > 0;
  }
}

bool World::Impl::are_joined(int body_a, int body_b) const {
  const Body &a = data.bodies[body_a], &b = data.bodies[body_b];
  if (a.tree >= 0 && a.tree == b.tree) {
    const std::vector<TreeLink>& links = data.trees[a.tree].links;
    if (data.trees[a.tree].tube && std::abs(a.link - b.link) <= 2) return true;
    const TreeLink &one = links[a.link], &other = links[b.link];
    if (one.parent == b.link) return !one.collide;
    if (other.parent == a.link) return !other.collide;
    for (const TreeLoop& loop : data.trees[a.tree].loops) {
      const bool these = (loop.link_a == a.link && loop.link_b == b.link) ||
                         (loop.link_a == b.link && loop.link_b == a.link);
      if (these) return !loop.collide;
    }
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
      tree_motions[tree].begin(data.trees[tree], simbody_trees.at(tree), options.gravity,
                               options.step);
    }
  });
  for (std::int32_t index : active) {
    if (!data.pairs[index].live) continue;
    for (std::int32_t body : {data.contacts[index].body_a, data.contacts[index].body_b}) {
      if (body != kGround && data.bodies[body].tree >= 0) is_solved[data.bodies[body].tree] = 1;
    }
  }
  for (std::int32_t tree : awake_trees) {
    const bool asks = tree_motions[tree].has_rows() || tree_motions[tree].near_stop();
    if (asks) is_solved[tree] = 1;
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
      if (is_solved[tree] && motion.impelled) {
        motion.finish();
      } else {
        if (is_solved[tree]) motion.begin_again();
        motion.move_freely();
      }
      motion.note_loads();
      mirror_tree(tree, motion);
    }
  });
}

void World::Impl::mirror_link(TreeLink& link, const Pose& to) {
  Body& body = data.bodies[link.body];
  const Quat turn = body.world_from_com.rotation.conjugate() * to.rotation;
  body.travel += distance(body.world_from_com.translation, to.translation) +
                 2 * norm(Vec3{turn.x, turn.y, turn.z}) * double(body.radius);
  body.world_from_com = to;
  body.linear = Vec3f(link.linear);
  body.angular = Vec3f(link.angular);
  refresh(body);
}

void World::Impl::mirror_tree(int tree, const TreeMotion& motion) {
  std::vector<TreeLink>& links = data.trees[tree].links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].mobility == Mobility::fixed) continue;
    links[i].linear = motion.linear_velocity(i);
    links[i].angular = motion.angular_velocity(i);
    mirror_link(links[i], motion.world_from_links()[i]);
  }
}

// The same from what Simbody holds, after it was changed from outside.
void World::Impl::mirror_state(int tree) {
  std::vector<TreeLink>& links = data.trees[tree].links;
  SimbodyTree& simbody = simbody_trees.at(tree);
  const TreePose& pose = simbody.pose();
  std::vector<Spatial> motions;
  std::vector<Pose> poses;
  calc_motions(data.trees[tree], pose, simbody.state().u, motions);
  simbody.calc_world_from_links(poses);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].mobility == Mobility::fixed) continue;
    links[i].linear = pose.links[i].centre_velocity(motions[i]);
    links[i].angular = motions[i].angular();
    mirror_link(links[i], poses[i]);
  }
}

// Nobody falls asleep before all links of its tree do.
void World::Impl::keep_trees_whole() {
  for (std::int32_t tree : awake_trees) {
    bool all = !data.trees[tree].driven;
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
  std::vector<JointState> joints;
  for (const Tree& tree : w.data.trees) {
    for (const TreeLink& link : tree.links) {
      if (link.parent < 0) continue;
      JointState joint;
      joint.parent = tree.links[std::size_t(link.parent)].body;
      joint.child = link.body;
      joint.kind = kind_of(link.mobility);
      joint.parent_from_joint =
          Pose{{}, w.data.bodies[joint.parent].com_in_type} * link.parent_from_joint;
      joint.child_from_joint =
          Pose{{}, w.data.bodies[joint.child].com_in_type} * link.link_from_joint;
      joint.rest = link.rest;
      joint.rest_rotation = link.rest_rotation;
      joints.push_back(joint);
    }
    for (const TreeLoop& loop : tree.loops) {
      JointState joint;
      joint.parent = tree.links[std::size_t(loop.link_a)].body;
      joint.child = tree.links[std::size_t(loop.link_b)].body;
      joint.kind = kind_of(loop.mobility);
      joint.parent_from_joint = Pose{{}, w.data.bodies[joint.parent].com_in_type} * loop.a_from_joint;
      joint.child_from_joint = Pose{{}, w.data.bodies[joint.child].com_in_type} * loop.b_from_joint;
      joints.push_back(joint);
    }
  }
  // A piece hangs on one other at most; then come the joints that close loops, as they were made.
  std::stable_sort(joints.begin(), joints.end(), [](const JointState& a, const JointState& b) {
    return a.child < b.child;
  });
  return joints;
}

}  // namespace rubble
