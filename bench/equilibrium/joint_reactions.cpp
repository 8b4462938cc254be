#include "bench/equilibrium/joint_reactions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/error.h"

namespace rubble {
namespace {

// A joint nearer to its stop than this leans on it. unit: rad, m
constexpr double kAtStop = 0.01, kAtEnd = 0.002;
constexpr double kTurn = 2 * 3.14159265358979323846;

// The pieces of one assembly.
struct Instance {
  const AssemblyType* assembly = nullptr;
  double scale = 1;
  int first = 0;
};

void add_instances(const Pile& pile, const std::vector<Placement>& placements, int& next,
                   std::vector<Instance>& instances) {
  for (const Placement& placement : placements) {
    if (!placement.kind.is_assembly) {
      ++next;
      continue;
    }
    const AssemblyType& type = pile.assemblies.at(std::size_t(placement.kind.index));
    instances.push_back({&type, placement.scale, next});
    next += int(type.links.size());
  }
}

// In the order in which the world numbers its pieces.
std::vector<Instance> find_instances(const Pile& pile) {
  std::vector<Instance> instances;
  int next = 0;
  add_instances(pile, pile.placed, next, instances);
  for (const Layer& layer : pile.layers) add_instances(pile, layer.pieces, next, instances);
  return instances;
}

const JointType* find_joint(const Instance& instance, const JointState& joint) {
  for (const JointType& type : instance.assembly->joints) {
    if (instance.first + type.child == joint.child && instance.first + type.parent == joint.parent)
      return &type;
  }
  return nullptr;
}

// Coordinates of the joint at rest and what its frame is in the world.
struct JointPose {
  Pose world_from_joint;  // on the parent's side
  Pose joint;             // of the child's frame in it
};

JointPose calc_pose(const JointState& joint, const PileState& state) {
  const auto& parent = state.pieces[std::size_t(joint.parent)];
  const auto& child = state.pieces[std::size_t(joint.child)];
  JointPose pose;
  pose.world_from_joint = parent.world_from_body * joint.parent_from_joint;
  pose.joint =
      pose.world_from_joint.inverse() * (child.world_from_body * joint.child_from_joint);
  return pose;
}

class LoadMaker {
 public:
  LoadMaker(const DesignedJoint& joint, const PileState& state)
      : type_(*joint.type), rests_(*joint.state), scale_(joint.scale),
        pose_(calc_pose(*joint.state, state)) {
    load_.point = pose_.world_from_joint * pose_.joint.translation;
  }

  JointLoad make() {
    switch (rests_.kind) {
      case JointKind::weld:
        hold(0b111, 0b111);
        break;
      case JointKind::hinge:
        hold(0b111, 0b011);
        spring_of_hinge();
        break;
      case JointKind::slider:
        hold(0b110, 0b111);
        spring_of_slider();
        break;
      case JointKind::ball:
        hold(0b111, 0b000);
        spring_of_ball();
        break;
    }
    return load_;
  }

 private:
  Vec3 axis(int i) const {
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return pose_.world_from_joint.rotation.rotate(axes[i]);
  }

  // Bit i: along or about axis i of the joint's frame.
  void hold(unsigned forces, unsigned torques) {
    for (int i = 0; i < 3; ++i) {
      if (forces >> i & 1) push(axis(i), {}, false);
      if (torques >> i & 1) push({}, axis(i), false);
    }
  }

  void push(const Vec3& force, const Vec3& torque, bool one_sided,
            double limit = std::numeric_limits<double>::infinity()) {
    load_.reactions.push_back(
        {kImmovable, kImmovable, force, torque, load_.point, one_sided, limit});
  }

  // Dry friction of the joint, along or about an axis of its frame. unit of most: N, N m
  void rub(const Vec3& force, const Vec3& torque, double most) {
    if (most > 0) push(force, torque, false, most);
  }

  void spring_of_hinge() {
    const Quat& r = pose_.joint.rotation;
    const double angle = std::remainder(2 * std::atan2(r.z, r.w), kTurn);
    const double bend = std::remainder(angle - rests_.rest, kTurn);
    const double s3 = scale_ * scale_ * scale_;
    load_.spring_torque = axis(2) * (-type_.stiffness * s3 * bend);
    rub({}, axis(2), type_.friction * s3);
    if (angle < type_.lower + kAtStop) push({}, axis(2), true);
    if (angle > type_.upper - kAtStop) push({}, -axis(2), true);
  }

  void spring_of_slider() {
    const double travel = pose_.joint.translation.x;
    load_.spring_force = axis(0) * (-type_.stiffness * scale_ * (travel - rests_.rest));
    rub(axis(0), {}, type_.friction * scale_ * scale_);
    if (travel < type_.lower * scale_ + kAtEnd) push(axis(0), {}, true);
    if (travel > type_.upper * scale_ - kAtEnd) push(-axis(0), {}, true);
  }

  void spring_of_ball() {
    const Quat bend = pose_.joint.rotation * rests_.rest_rotation.conjugate();
    const double sign = bend.w < 0 ? -1 : 1, s3 = scale_ * scale_ * scale_;
    const Vec3 torque = Vec3{bend.x, bend.y, bend.z} * (-2 * sign * type_.stiffness * s3);
    load_.spring_torque = pose_.world_from_joint.rotation.rotate(torque);
    for (int i = 0; i < 3; ++i) rub({}, axis(i), type_.friction * s3);
    const Quat& r = pose_.joint.rotation;
    const Vec3 turn = Vec3{r.x, r.y, r.z} * (r.w < 0 ? -1.0 : 1.0);
    const double angle = 2 * std::atan2(norm(turn), std::abs(r.w));
    if (angle > type_.upper - kAtStop)
      push({}, pose_.world_from_joint.rotation.rotate(-normalized(turn)), true);
  }

  const JointType& type_;
  const JointState& rests_;
  double scale_;
  JointPose pose_;
  JointLoad load_;
};

}  // namespace

std::vector<DesignedJoint> find_designed_joints(const Pile& pile, const PileState& state) {
  const std::vector<Instance> instances = find_instances(pile);
  std::vector<DesignedJoint> joints;
  for (const JointState& joint : state.joints) {
    // The last that begins at the parent or before.
    auto instance = std::upper_bound(
        instances.begin(), instances.end(), int(joint.parent),
        [](int piece, const Instance& other) { return piece < other.first; });
    const JointType* type =
        instance == instances.begin() ? nullptr : find_joint(*std::prev(instance), joint);
    if (!type)
      throw InputError({"", 0, "joints", "the settled pile has a joint that its mission has not",
                        "the mission and the seed that the pile was settled from",
                        "a joint of pieces " + std::to_string(joint.parent) + " and " +
                            std::to_string(joint.child),
                        ""});
    joints.push_back({&joint, type, std::prev(instance)->scale});
  }
  return joints;
}

PiecePairs find_pairs_apart(const std::vector<DesignedJoint>& joints) {
  PiecePairs apart;
  for (const DesignedJoint& joint : joints) {
    if (!joint.type->collide)
      apart.insert(std::minmax(int(joint.state->parent), int(joint.state->child)));
  }
  return apart;
}

JointLoad calc_joint_load(const DesignedJoint& joint, const PileState& state) {
  return LoadMaker(joint, state).make();
}

}  // namespace rubble
