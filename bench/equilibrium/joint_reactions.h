// What the joints of articulated debris carry: forces and torques that hold, springs, stops.
#pragma once

#include <vector>

#include "bench/equilibrium/balance.h"
#include "bench/equilibrium/contact_finder.h"
#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// A joint that holds, with its figures as designed.
struct DesignedJoint {
  const JointState* state = nullptr;
  const JointType* type = nullptr;
  double scale = 1;  // of the assembly
};

// In the order of state.joints. Throws InputError when the state is not of this pile.
std::vector<DesignedJoint> find_designed_joints(const Pile& pile, const PileState& state);

// Joined pieces that do not collide.
PiecePairs find_pairs_apart(const std::vector<DesignedJoint>& joints);

// What a joint does at rest, in the world: any multiple of the reactions, and the spring's own
// torque and force, which the pose of the joint states.
struct JointLoad {
  std::vector<BalanceReaction> reactions;  // bodies not yet set
  Vec3 spring_force, spring_torque;        // on the child; unit: N, N m
  Vec3 point;                              // of the joint; unit: m
};
JointLoad calc_joint_load(const DesignedJoint& joint, const PileState& state);

}  // namespace rubble
