// A pile at one instant, as plain data: the result of settling and the input of all later stages.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/model/assembly.h"
#include "kernel/model/fines.h"
#include "kernel/model/surroundings.h"

namespace rubble {

enum class PieceStatus : std::uint8_t {
  resting,  // below the speed limits, or asleep
  moving,  // faster than the speed limits
  fixed,
  lost,  // left the world and was removed; its pose is the last one seen
};

struct PieceState {
  std::int32_t type = 0;                     // index into the pile's types
  std::int32_t layer = 0;                    // -1: placed before the first layer
  double scale = 1;                          // of the type's lengths; above 0
  Pose world_from_body;                      // body: the frame of the type's parts
  Vec3 linear_velocity;                      // of the centre of mass, in the world; unit: m/s
  Vec3 angular_velocity;                     // in the world; unit: rad/s
  PieceStatus status = PieceStatus::moving;  // when settling ended
};

// An unbroken joint. Broken joints are not listed.
struct JointState {
  std::int32_t parent = 0, child = 0;        // indices of the pieces
  JointKind kind = JointKind::ball;          // as defined in the pack
  Pose parent_from_joint, child_from_joint;  // in the frames of the pieces' types, scaled; unit: m
  double rest = 0;                           // rest of the spring of a hinge or slider; unit: rad, m
  Quat rest_rotation;                        // rest of the spring of a ball, on the parent's side
};

// A tie between two pieces, or a piece and the ground: reinforcing bars that hold after the concrete around
// them has failed. It pulls when it is longer than `length`, with at most `strength`. At this force it yields
// and becomes longer. It tears when it has used up `stretch`.
struct TieState {
  std::int32_t piece_a = 0, piece_b = -1;  // b: -1 is the ground
  Vec3 anchor_a, anchor_b;  // in the frames of the pieces' types, scaled; of the ground in the world; unit: m
  double length = 0;        // unit: m; > 0
  double strength = 0;      // unit: N; > 0
  double stretch = 0;       // remaining elongation; unit: m; >= 0
  double bending = 0;       // moment by which bent bars damp the rotation of the pieces; unit: N m; >= 0
};

// What a contact carries at one of its points at rest. Where pieces are wedged, it does not follow from their poses.
struct ContactLoad {
  std::int32_t piece = 0, other = -1;  // other: -1 is the ground
  Vec3f point;                         // in the world; unit: m
  Vec3f force;                         // on the piece; unit: N
};

// The connections that remain in a collapsed building, and what they carry. They are needed if its pieces can move again.
struct BuildingState {
  std::int32_t first = 0, count = 0;  // its pieces, after the placed ones; count 0: no building
  // Groups of two or more pieces that move as one rigid body, ascending. All pieces of a group have the same
  // status. Pieces in no group move alone.
  std::vector<std::vector<std::int32_t>> bodies;
  std::vector<TieState> ties;  // unbroken, in the order of their creation
  // Of all contacts of the pile, and of the ties in their order (unit: N). Empty: not known.
  std::vector<ContactLoad> loads;
  std::vector<float> tie_forces;
};

// The deepest overlap of two pieces, or of a piece and the ground.
struct DeepestOverlap {
  double depth = 0;                        // 0: none; unit: m
  std::int32_t piece_a = -1, piece_b = -1;  // b: -1 is the ground
};

struct PileState {
  std::vector<PieceState> pieces;   // in creation order, with lost pieces
  std::vector<JointState> joints;   // of articulated debris, by parent and child
  BuildingState building;           // its pieces are among those above
  std::vector<std::string> types;   // names of the types
  std::int64_t steps = 0;           // number of steps until rest or until the limit
  double simulated = 0;             // unit: s
  // Every piece rests, the time limit after the last layer was not reached, and no overlap is deeper than
  // the options allow.
  bool settled = false;
  DeepestOverlap deepest_overlap;  // when settling ended; not kept in files
  int layers_at_limit = 0;         // layers whose time limit came before rest
  int lost = 0;                    // pieces that left the world
  // Added when the pile rests; none by default. Not in the state hash; saved in a file of their own.
  Fines fines;
  // Surroundings of the pile; null by default. Not saved: they follow from the scenario and the pile.
  std::shared_ptr<const Surroundings> surroundings;

  // XXH64 over the bit patterns of every field of the pieces in their order, then of the joints in their
  // order, each list after its length, then the step count. Names of types and the BuildingState are left
  // out.
  std::uint64_t state_hash() const;
};

}  // namespace rubble
