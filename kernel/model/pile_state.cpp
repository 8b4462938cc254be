#include "kernel/model/pile_state.h"

#include "kernel/base/hash_pose.h"

namespace rubble {
namespace {

void add(StateHash& hash, const PieceState& piece) {
  hash.add(piece.type), hash.add(piece.layer), hash.add(piece.scale);
  add(hash, piece.world_from_body);
  add(hash, piece.linear_velocity);
  add(hash, piece.angular_velocity);
  hash.add(std::uint8_t(piece.status));
}

void add(StateHash& hash, const JointState& joint) {
  hash.add(joint.parent), hash.add(joint.child), hash.add(std::uint8_t(joint.kind));
  add(hash, joint.parent_from_joint);
  add(hash, joint.child_from_joint);
  hash.add(joint.rest);
  add(hash, joint.rest_rotation);
}

}  // namespace

std::uint64_t PileState::state_hash() const {
  StateHash hash;
  hash.add(std::uint64_t(pieces.size()));
  for (const PieceState& piece : pieces) add(hash, piece);
  hash.add(std::uint64_t(joints.size()));
  for (const JointState& joint : joints) add(hash, joint);
  hash.add(steps);
  return hash.digest();
}

}  // namespace rubble
