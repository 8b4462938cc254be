// Articulated debris in piles: rest, threads, snapshots, layers.
#include <gtest/gtest.h>

#include <algorithm>

#include "kernel/base/error.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world.h"
#include "kernel/world/world_snapshot.h"
#include "scenes.h"

namespace rubble {
namespace articulated_pile_test {

using testing::at;
using testing::run;
using testing::turned;

// Slabs joined by stiff bars that yield, dropped on free pieces.
TEST(ArticulatedPile, AChainOfSlabsComesToRest) {
  World world(testing::rubble_types(), {}, testing::assemblies());
  std::vector<NewPiece> pieces;
  for (int i = 0; i < 6; ++i) pieces.push_back(at(3, {0.5 * i, 0.1 * (i % 3), 0.15}));
  pieces.push_back(at(PieceKind::assembly(0), {0, 0, 1.2}, turned({1, 1, 0}, 0.3)));
  const int first = world.add(pieces) + 6;
  EXPECT_EQ(world.size(), 10);
  EXPECT_TRUE(testing::run_to_rest(world, 6));
  double lowest = 1;
  for (int i = first; i < first + 4; ++i) {
    lowest = std::min(lowest, world.piece(i).world_from_body.translation.z);
    EXPECT_TRUE(world.is_touching(i));
  }
  EXPECT_LT(lowest, 0.4);
  EXPECT_EQ(world.lost_count(), 0);
  // Joints hold to the last digit: positions come from the joint's coordinates alone.
  for (const JointState& joint : world.joints()) {
    const Vec3 a = world.piece(joint.parent).world_from_body * joint.parent_from_joint.translation;
    const Vec3 b = world.piece(joint.child).world_from_body * joint.child_from_joint.translation;
    EXPECT_LT(distance(a, b), 1e-12);
  }
  run(world, 3);
  EXPECT_EQ(world.awake_count(), 0);
  // Asleep as a whole, awake as a whole.
  world.set_velocity(first + 3, {0, 0, 0.5}, {});
  for (int i = first; i < first + 4; ++i) EXPECT_TRUE(world.is_awake(i));
}

// An assembly with an immovable root is all there is: its other links fall until their joints hold them.
TEST(ArticulatedPile, LinksOfAFixedRootFallWithNothingElseThere) {
  PileSpec spec = testing::small_pile(62, 0, 0);
  spec.assemblies = testing::assemblies();
  spec.placed = {at(PieceKind::assembly(0), {0, 0, 3}, {}, true).placement};
  SettleOptions options;
  options.final_time_limit = 2;
  const PileState state = settle_pile(generate_pile(spec), options);
  EXPECT_GT(state.steps, 0);
  double moved = 0;
  const double height = state.pieces.front().world_from_body.translation.z;
  for (const PieceState& piece : state.pieces) moved = std::max(moved, height - piece.world_from_body.translation.z);
  EXPECT_GT(moved, 0.05);
}

PileSpec mixed_pile(std::uint64_t seed) {
  PileSpec spec = testing::small_pile(seed, 2, 40);
  spec.assemblies = testing::assemblies();
  spec.mix.push_back({PieceKind::assembly(0), 3, 0.7, 1.1});
  spec.mix.push_back({PieceKind::assembly(1), 3, 0.7, 1.1});
  spec.placed = {at(PieceKind::assembly(0), {0, 0, 1.2}, {}, true).placement};
  return spec;
}

TEST(ArticulatedPile, PilesAreTheSameForAnyNumberOfThreads) {
  const Pile pile = generate_pile(mixed_pile(61));
  std::uint64_t first = 0;
  for (int threads : {1, 2, 3, 8}) {
    SettleOptions options;
    options.threads = threads;
    options.layer_time_limit = 2;
    options.final_time_limit = 2;
    const PileState state = settle_pile(pile, options);
    if (threads == 1) first = state.state_hash();
    EXPECT_EQ(state.state_hash(), first) << threads;
    EXPECT_GT(state.pieces.size(), 84u);
    EXPECT_GT(state.joints.size(), 3u);
  }
}

TEST(ArticulatedPile, SaveRestoreRepeat) {
  PileSpec spec = mixed_pile(62);
  const Pile pile = generate_pile(spec);
  World world(pile.types, {}, pile.assemblies);
  std::vector<NewPiece> pieces;
  for (const Placement& placement : pile.layers[0].pieces) {
    pieces.push_back({});
    pieces.back().placement = placement;
  }
  world.add(pieces);
  const std::size_t whole = world.joints().size();
  for (int round = 0; round < 5; ++round) {
    run(world, 0.4);
    const auto bytes = encode_snapshot(*world.snapshot());
    World fresh(pile.types, {}, pile.assemblies);
    fresh.restore(*decode_snapshot(bytes));
    EXPECT_EQ(encode_snapshot(*fresh.snapshot()), bytes);
    World copy(pile.types, {}, pile.assemblies);
    copy.restore(*world.snapshot());
    run(world, 0.3);
    run(fresh, 0.3);
    run(copy, 0.3);
    EXPECT_EQ(testing::hash_of(fresh), testing::hash_of(world)) << round;
    EXPECT_EQ(testing::hash_of(copy), testing::hash_of(world)) << round;
  }
  EXPECT_GT(world.joints().size(), 0u);
  EXPECT_LT(world.joints().size(), whole);  // some broke on the way
  World other(pile.types, {}, {testing::assemblies()[0]});
  EXPECT_THROW(other.restore(*world.snapshot()), RunError);
}

TEST(ArticulatedPile, LayersDropAssembliesWithoutOverlap) {
  const Pile pile = generate_pile(mixed_pile(63));
  int assemblies = 0;
  for (const Layer& layer : pile.layers) {
    for (const Placement& p : layer.pieces) assemblies += p.kind.is_assembly;
  }
  EXPECT_GT(assemblies, 3);
  EXPECT_EQ(pile.layers[0].pieces.size(), 40u);
}

}  // namespace articulated_pile_test
}  // namespace rubble
