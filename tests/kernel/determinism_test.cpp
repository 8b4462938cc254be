#include <gtest/gtest.h>

#include "kernel/base/hash.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world.h"
#include "scenes.h"

namespace rubble {
namespace determinism_test {

using testing::hash_of;
using testing::small_pile;

std::uint64_t settled_hash(const Pile& pile, int threads) {
  SettleOptions options;
  options.threads = threads;
  return settle_pile(pile, options).state_hash();
}

std::vector<NewPiece> first_layer(const Pile& pile) {
  std::vector<NewPiece> pieces;
  for (const Placement& p : pile.layers[0].pieces) {
    pieces.push_back({});
    pieces.back().placement = p;
    pieces.back().placement.world_from_body.translation.z += 0.5;
  }
  return pieces;
}

World make_world(const Pile& pile, int threads) {
  WorldOptions options;
  options.threads = threads;
  World world(pile.types, options);
  world.add(first_layer(pile));
  return world;
}

// The first body and field in which two worlds differ, or an empty string.
std::string first_difference(const World& a, const World& b) {
  const auto differs = [](const Vec3& u, const Vec3& v) {
    return u.x != v.x || u.y != v.y || u.z != v.z;
  };
  for (int i = 0; i < a.size(); ++i) {
    const PieceState p = a.piece(i), q = b.piece(i);
    const std::string body = "body " + std::to_string(i) + ", ";
    if (differs(p.world_from_body.translation, q.world_from_body.translation)) {
      return body + "translation";
    }
    if (!(p.world_from_body.rotation == q.world_from_body.rotation)) return body + "rotation";
    if (differs(p.linear_velocity, q.linear_velocity)) return body + "linear velocity";
    if (differs(p.angular_velocity, q.angular_velocity)) return body + "angular velocity";
  }
  return {};
}

// Steps both and names the first step, body and field that differ.
std::string lockstep(World& a, World& b, int steps) {
  for (int step = 1; step <= steps; ++step) {
    a.step();
    b.step();
    const std::string difference = first_difference(a, b);
    if (!difference.empty()) return "step " + std::to_string(step) + ", " + difference;
  }
  return {};
}

TEST(Determinism, TheSameTwice) {
  const Pile pile = generate_pile(small_pile(31));
  EXPECT_EQ(hex64(settled_hash(pile, 1)), hex64(settled_hash(pile, 1)));
}

TEST(Determinism, TheSameForAnyThreadCount) {
  const Pile pile = generate_pile(small_pile(32));
  const std::string one = hex64(settled_hash(pile, 1));
  for (int threads : {2, 3, 8}) EXPECT_EQ(hex64(settled_hash(pile, threads)), one) << threads;
}

TEST(Determinism, LockstepOverThreads) {
  const Pile pile = generate_pile(small_pile(33, 1, 100));
  World one = make_world(pile, 1), eight = make_world(pile, 8);
  EXPECT_EQ(lockstep(one, eight, 240), "");
}

TEST(Determinism, AnotherSeedGivesAnotherHash) {
  EXPECT_NE(settled_hash(generate_pile(small_pile(34, 1)), 1),
            settled_hash(generate_pile(small_pile(35, 1)), 1));
}

TEST(Determinism, ANanometreChangesTheHashAndLockstepNamesIt) {
  const Pile pile = generate_pile(small_pile(36, 1, 40));
  World a = make_world(pile, 1), b = make_world(pile, 1);
  Pose pose = b.piece(17).world_from_body;
  pose.translation.x += 1e-9;
  b.set_pose(17, pose);
  EXPECT_EQ(lockstep(a, b, 10), "step 1, body 17, translation");
  testing::run(a, 3);
  testing::run(b, 3);
  EXPECT_NE(hash_of(a), hash_of(b));
}

TEST(Determinism, RestoringASnapshotRepeatsTheSameBits) {
  const Pile pile = generate_pile(small_pile(37, 1, 80));
  World world = make_world(pile, 1);
  testing::run(world, 1.5);  // in the middle of the impacts
  const auto saved = world.snapshot();
  const std::uint64_t at_save = hash_of(world);
  testing::run(world, 1.5);
  const std::uint64_t once = hash_of(world);
  EXPECT_NE(at_save, once);
  world.restore(*saved);
  EXPECT_EQ(hash_of(world), at_save);
  testing::run(world, 1.5);
  EXPECT_EQ(hash_of(world), once);
}

TEST(Determinism, ASnapshotContinuesInAnotherWorld) {
  const Pile pile = generate_pile(small_pile(38, 1, 80));
  World world = make_world(pile, 1);
  testing::run(world, 1.5);
  World other = make_world(pile, 2);
  other.restore(*world.snapshot());
  EXPECT_EQ(lockstep(world, other, 90), "");
}

// Each field alone.
TEST(StateHash, ChangesWithEveryFieldOfPiecesAndJoints) {
  PileState state;
  state.pieces.resize(2), state.joints.resize(1);
  const std::uint64_t before = state.state_hash();
  const auto changed = [&](const char* what, const auto& change) {
    PileState other = state;
    change(other);
    EXPECT_NE(other.state_hash(), before) << what;
  };
  changed("type", [](PileState& s) { s.pieces[1].type = 3; });
  changed("layer", [](PileState& s) { s.pieces[1].layer = -1; });
  changed("scale", [](PileState& s) { s.pieces[1].scale = 1.5; });
  changed("status", [](PileState& s) { s.pieces[1].status = PieceStatus::fixed; });
  changed("place", [](PileState& s) { s.pieces[1].world_from_body.translation.y = 1e-300; });
  changed("turn", [](PileState& s) { s.pieces[1].world_from_body.rotation.x = 1e-9; });
  changed("velocity", [](PileState& s) { s.pieces[0].linear_velocity.z = -0.0; });
  changed("turn rate", [](PileState& s) { s.pieces[0].angular_velocity.x = 1; });
  changed("parent", [](PileState& s) { s.joints[0].parent = 1; });
  changed("child", [](PileState& s) { s.joints[0].child = 1; });
  changed("kind", [](PileState& s) { s.joints[0].kind = JointKind::hinge; });
  changed("parent frame", [](PileState& s) { s.joints[0].parent_from_joint.translation.x = 1; });
  changed("child frame", [](PileState& s) { s.joints[0].child_from_joint.rotation.z = 1; });
  changed("rest", [](PileState& s) { s.joints[0].rest = 0.1; });
  changed("rest rotation", [](PileState& s) { s.joints[0].rest_rotation.y = 0.1; });
  changed("a piece more", [](PileState& s) { s.pieces.emplace_back(); });
  changed("a joint less", [](PileState& s) { s.joints.clear(); });
  changed("steps", [](PileState& s) { s.steps = 1; });
  EXPECT_EQ(PileState(state).state_hash(), before);
}

}  // namespace determinism_test
}  // namespace rubble
