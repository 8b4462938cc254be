// Joints of a settled pile, found again from the plain state.
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/model/settled_joints.h"
#include "kernel/multibody/joints/joint.h"
#include "kernel/world/phases/trees.h"

namespace rubble {
namespace {

// The joint's coordinates that put the link where it is.
void set_coordinates(const Pose& moved, Mobility mobility, double* q) {
  const Quat& r = moved.rotation;
  switch (mobility) {
    case Mobility::hinge:
      q[0] = 2 * portable::atan2(r.w < 0 ? -r.z : r.z, r.w < 0 ? -r.w : r.w);
      break;
    case Mobility::slider:
      q[0] = moved.translation.x;
      break;
    case Mobility::ball:
      q[0] = r.w, q[1] = r.x, q[2] = r.y, q[3] = r.z;
      break;
    case Mobility::weld:
    case Mobility::free:
    case Mobility::fixed:
      break;
  }
}

// A hinge's angle, whole turns apart from `angle`: a rotation does not say how often the link went round. A spring or
// stops do: it is the nearest to rest, or one between the stops.
double with_turns(double angle, const TreeLink& link) {
  constexpr double kTurn = 2 * portable::kPi;
  if (link.stiffness > 0) return angle + kTurn * std::round((link.rest - angle) / kTurn);
  if (angle < link.lower && angle + kTurn <= link.upper) return angle + kTurn;
  if (angle > link.upper && angle - kTurn >= link.lower) return angle - kTurn;
  return angle;
}

}  // namespace

void WorldTrees::join_settled(const Pile& pile, const PileState& state) {
  const std::vector<SettledJoint> settled = list_settled_joints(pile, state);
  const int pieces = int(state.pieces.size());
  std::vector<const SettledJoint*> hangs_by(state.pieces.size(), nullptr);
  std::vector<std::uint8_t> joined(state.pieces.size(), 0);
  std::vector<const SettledJoint*> loops;
  for (const SettledJoint& joint : settled) {
    joined[std::size_t(joint.state->parent)] = joined[std::size_t(joint.state->child)] = 1;
    if (joint.loop)
      loops.push_back(&joint);
    else
      hangs_by[std::size_t(joint.state->child)] = &joint;
  }
  const auto frame = [&](int body, const Pose& type_from_joint) {
    return Pose{{}, -data_.bodies[body].com_in_type} * type_from_joint;
  };
  std::vector<Tree> trees;
  std::vector<TreeState> states;
  for (int i = 0; i < pieces; ++i) {
    if (!joined[std::size_t(i)] || data_.bodies[i].lost) continue;
    Body& body = data_.bodies[i];
    TreeLink link;
    link.body = i;
    const SettledJoint* const hangs = hangs_by[std::size_t(i)];
    const JointState* const joint = hangs ? hangs->state : nullptr;
    if (!hangs) {
      link.mobility = body.mass > 0 ? Mobility::free : Mobility::fixed;
      trees.emplace_back();
      states.emplace_back();
      trees.back().root = body.world_from_com;
      body.tree = std::int32_t(trees.size()) - 1;
    } else {
      const Body& parent = data_.bodies[joint->parent];
      if (!hangs->type || parent.tree < 0) refuse_joints("other joints");
      body.tree = parent.tree;
      link.parent = parent.link;
      link.mobility = mobility_of(joint->kind);
      link.parent_from_joint = frame(joint->parent, joint->parent_from_joint);
      link.link_from_joint = frame(i, joint->child_from_joint);
      joint_of(link.mobility).set_figures(*hangs->type, hangs->scale, link);
      link.rest = joint->rest;
      link.rest_rotation = joint->rest_rotation;
    }
    Tree& tree = trees[std::size_t(body.tree)];
    TreeState& at = states[std::size_t(body.tree)];
    body.link = std::int32_t(tree.links.size());
    tree.mass += body.mass;
    tree.links.push_back(link);
    number_coordinates(tree);
    at.q.resize(std::size_t(tree.q_count));
    at.u.assign(std::size_t(tree.u_count), 0);
    double* q = at.q.data() + tree.links.back().first_q;
    const Pose& pose = body.world_from_com;
    if (link.mobility == Mobility::free) {
      const Quat& r = pose.rotation;
      const Vec3& p = pose.translation;
      const double numbers[7] = {r.w, r.x, r.y, r.z, p.x, p.y, p.z};
      std::copy(numbers, numbers + 7, q);
    } else if (joint) {
      set_coordinates((data_.bodies[joint->parent].world_from_com * link.parent_from_joint).inverse() * pose *
                          link.link_from_joint,
                      link.mobility, q);
      if (link.mobility == Mobility::hinge) q[0] = with_turns(q[0], link);
    }
  }
  for (const SettledJoint* settled_loop : loops) {
    const JointState* const joint = settled_loop->state;
    const JointType* const type = settled_loop->type;
    const double scale = settled_loop->scale;
    const Body &a = data_.bodies[joint->parent], &b = data_.bodies[joint->child];
    if (!type || a.tree < 0 || a.tree != b.tree) refuse_joints("other joints");
    TreeLoop loop;
    loop.link_a = a.link;
    loop.link_b = b.link;
    loop.mobility = mobility_of(joint->kind);
    loop.a_from_joint = frame(joint->parent, joint->parent_from_joint);
    loop.b_from_joint = frame(joint->child, joint->child_from_joint);
    loop.break_force = type->break_force * (scale * scale);
    loop.break_torque = type->break_torque * (scale * scale * scale);
    loop.collide = type->collide;
    trees[std::size_t(a.tree)].loops.push_back(loop);
  }
  for (std::size_t i = 0; i < trees.size(); ++i) {
    data_.trees.push_back(trees[i]);
    simbody_.add(trees[i], data_.bodies, states[i]);
    mirror_state(int(i));
  }
}

}  // namespace rubble
