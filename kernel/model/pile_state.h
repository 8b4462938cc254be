// A pile at one instant: plain data, the product of settling and the input of all that follows.
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

// A joint that holds. Joints that broke are not there any more.
struct JointState {
  std::int32_t parent = 0, child = 0;        // indices of the pieces
  JointKind kind = JointKind::ball;          // of the joint that the pack states
  Pose parent_from_joint, child_from_joint;  // in the frames of the pieces' types, scaled; unit: m
  double rest = 0;                           // of the spring of a hinge or slider, crept; unit: rad, m
  Quat rest_rotation;                        // of a ball's; on the parent's side
};

// A tie between two pieces, or a piece and the ground: bars that hold after the concrete around them has
// failed. It only pulls, and when it is longer than `length`: with `strength` at most. Then it yields, which
// makes it longer, and tears when that has taken all of `stretch`.
struct TieState {
  std::int32_t piece_a = 0, piece_b = -1;  // b: -1 is the ground
  Vec3 anchor_a, anchor_b;  // in the frames of the pieces' types, scaled; of the ground in the world; unit: m
  double length = 0;        // unit: m; > 0
  double strength = 0;      // unit: N; > 0
  double stretch = 0;       // that is left; unit: m; >= 0
  double bending = 0;       // moment by which bent bars brake their pieces' turning; unit: N m; >= 0
};

// A building after its collapse: what of it still holds together. Needed wherever its pieces can move again.
struct BuildingState {
  std::int32_t first = 0, count = 0;  // its pieces, after the placed ones; count 0: no building
  // Pieces that move as one rigid body, two or more each, ascending. Their statuses are equal. Pieces in none
  // of these move alone.
  std::vector<std::vector<std::int32_t>> bodies;
  std::vector<TieState> ties;  // that hold, in the order in which they were added
};

// Two pieces, or one and the ground, that reach into each other.
struct DeepestOverlap {
  double depth = 0;                        // 0: none; unit: m
  std::int32_t piece_a = -1, piece_b = -1;  // b: -1 is the ground
};

struct PileState {
  std::vector<PieceState> pieces;   // in creation order, lost ones too
  std::vector<JointState> joints;   // of articulated debris, by parent and child
  BuildingState building;           // its pieces are among those above
  std::vector<std::string> types;   // names of the types
  std::int64_t steps = 0;           // steps taken until rest or until the limit
  double simulated = 0;             // unit: s
  // Every piece rests, no layer ran into its limit at the end, and no overlap is deeper than the
  // options allow.
  bool settled = false;
  DeepestOverlap deepest_overlap;  // when settling ended; not kept in files
  int layers_at_limit = 0;         // layers whose time limit came before rest
  int lost = 0;                    // pieces that left the world
  // Strewn when all rests; none by default. Not in the state's hash, and in a file of their own.
  Fines fines;
  // What stands about it; null by default. In no file: it follows from the scenario and the pile.
  std::shared_ptr<const Surroundings> surroundings;

  // XXH64 over the bit patterns of every field of the pieces in their order, then of the joints in
  // theirs, each list after its length, then the step count. The names of types are not in it, nor is the
  // BuildingState.
  std::uint64_t state_hash() const;
};

}  // namespace rubble
