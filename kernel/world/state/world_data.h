// Data of a world: the state that changes from step to step, and the types of its pieces. Not for use outside kernel/.
#pragma once

#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include "kernel/collision/body.h"
#include "kernel/collision/broad_phase.h"
#include "kernel/collision/contact.h"
#include "kernel/collision/narrow_phase.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/robot.h"
#include "kernel/model/world_input.h"
#include "kernel/multibody/tree.h"
#include "kernel/solver/contact_solver.h"

namespace rubble {

// Which bodies are a robot: those from `first_body` on, in the order of its links.
struct WorldRobot {
  std::int32_t tree = 0, first_body = 0;
  // Of a tube: how many of its links have grown, how far the tip has come beyond them (unit: m), and the
  // curvature of what grows now (unit: 1/m).
  std::int32_t laid = 0;
  double reached = 0, curve_left = 0, curve_up = 0;
};

// Pieces that hold together: one rigid body.
struct RigidGroup {
  std::vector<std::int32_t> members;  // ascending; the first one leads. Empty: there is no such group
  Vec3f reach;                        // largest |x|, |y|, |z| of any corner; unit: m
};

// A tie as the solver sees it: a contact between its anchors that pulls.
struct Tie {
  TieState state;
  Contact contact;      // of the bodies that its pieces move with
  float order = 1e30F;  // height that decides its place in the solver's order; unit: m
  bool solved = false;  // took part in the last step
};

// All that changes from step to step. Its members and theirs are listed in world_serialization.h as well.
struct WorldData {
  std::vector<Body> bodies;
  std::vector<Collider> colliders;
  std::vector<Vec3f> corners;  // turned to the world, from the centre of mass of their piece
  BroadPhase broad;
  std::vector<Pair> pairs;                                          // of parts that are near each other
  std::vector<Contact> contacts;                                    // one per pair
  std::unordered_map<std::uint64_t, std::int32_t> contact_of_pair;  // looked up, never walked
  std::vector<std::uint8_t> wake_next;                              // by body
  std::vector<Tree> trees;  // those that came apart keep their place, without links
  std::vector<WorldRobot> robots;
  std::vector<RigidGroup> groups;  // those that came apart keep their place
  std::vector<Tie> ties;           // that hold
  double tie_energy = 0;           // see World::tie_energy(); unit: J
  std::int64_t steps = 0;
  std::int64_t verification_steps = -1;  // since begin_rest_verification(); -1: no verification
  std::int64_t all_awake_since = -1;     // in verification_steps; -1: some pieces doze
  std::int64_t verification_limit = 0;   // steps after which nobody waits for its end any more
  // In verification_steps: since when rest is tried without rolling resistance; -1: it is not.
  std::int64_t undamped_since = -1;
  std::int32_t undamped_tries = 0;  // in this verification
  int lost = 0;
};

// Types of the pieces.
struct WorldTypes {
  std::vector<PieceType> pieces;  // those of surfaces and of the links of robots come last
  int placeable = 0;              // the others
  std::vector<AssemblyType> assemblies;
  std::deque<Shape> shapes;  // by type; bodies point at them
  std::vector<RobotModel> robots;
  std::vector<Tree> grown_robots;  // by robot: of a tube, the tree when all of it has grown
};

struct WorldSettings {
  WorldOptions options;
  SolverSettings solver;
  NarrowSettings narrow;
};

}  // namespace rubble
