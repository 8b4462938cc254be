#include "kernel/model/pile_state.h"

#include "kernel/base/hash.h"

namespace rubble {

std::uint64_t PileState::state_hash() const {
  StateHash hash;
  const auto add = [&hash](const Vec3& v) { hash.add(v.x), hash.add(v.y), hash.add(v.z); };
  for (const PieceState& piece : pieces) {
    const Quat& q = piece.world_from_body.rotation;
    hash.add(q.w), hash.add(q.x), hash.add(q.y), hash.add(q.z);
    add(piece.world_from_body.translation);
    add(piece.linear_velocity);
    add(piece.angular_velocity);
  }
  for (const JointState& joint : joints) {
    const Quat& q = joint.rest_rotation;
    hash.add(joint.parent), hash.add(joint.child), hash.add(joint.rest);
    hash.add(q.w), hash.add(q.x), hash.add(q.y), hash.add(q.z);
  }
  hash.add(steps);
  return hash.digest();
}

}  // namespace rubble
