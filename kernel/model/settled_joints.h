// The joints of a settled pile with the figures of their types: a PileState keeps what changed, the pile the rest.
#pragma once

#include <vector>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct SettledJoint {
  const JointState* state = nullptr;
  const JointType* type = nullptr;  // at scale 1; null: the pile has no such joint
  double scale = 1;                 // of the assembly
  bool loop = false;                // closes a loop: its child hangs on another joint
};

// One for each of state.joints, in their order. Both arguments must outlive it. Throws InputError for a state of another
// pile.
std::vector<SettledJoint> list_settled_joints(const Pile& pile, const PileState& state);

[[noreturn]] void refuse_joints(const std::string& what);

}  // namespace rubble
