#include "kernel/model/pile_state.h"

#include <stdexcept>

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

const std::array<std::string, kFineKinds>& fine_names() {
  static const std::array<std::string, kFineKinds> names{"grit",  "plaster", "glass", "paper",
                                                         "cloth", "dust",    "cable", "pipe"};
  return names;
}

const std::vector<FineHeap>& Fines::heaps() const {
  static const std::vector<FineHeap> none;
  if (!gathered && !empty()) throw std::logic_error("fines without heaps: heap_fines() makes them");
  return gathered ? *gathered : none;
}

const std::array<std::string, kSurroundingKinds>& surrounding_names() {
  static const std::array<std::string, kSurroundingKinds> names{
      "road", "kerb",    "pavement",    "soil",   "building", "tree",
      "fence", "vehicle", "street_lamp", "puddle", "skyline"};
  return names;
}

}  // namespace rubble
