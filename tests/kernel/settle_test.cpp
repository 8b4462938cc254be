#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"

#include <gtest/gtest.h>

#include "kernel/base/error.h"
#include "scenes.h"

namespace rubble {
namespace settle_test {

using testing::small_pile;

TEST(Settle, APileComesToRest) {
  const Pile pile = generate_pile(small_pile(21));
  const PileState state = settle_pile(pile);
  EXPECT_TRUE(state.settled);
  ASSERT_EQ(state.pieces.size(), 120u);
  EXPECT_EQ(state.lost, 0);
  for (const PieceState& piece : state.pieces) {
    EXPECT_EQ(piece.status, PieceStatus::resting);
    EXPECT_LT(norm(piece.linear_velocity), 0.05);
    EXPECT_LT(norm(piece.angular_velocity), 0.2);
  }
  EXPECT_EQ(state.pieces[0].layer, 0);
  EXPECT_EQ(state.pieces[119].layer, 1);
  EXPECT_EQ(state.types.size(), pile.types.size());
}

TEST(Settle, PlanesAreFasterAndAlsoCheckedAtTheEnd) {
  const Pile pile = generate_pile(small_pile(22, 3, 40));
  SettleOptions options;
  const PileState layers = settle_pile(pile, options);
  options.schedule = Schedule::planes;
  const PileState planes = settle_pile(pile, options);
  EXPECT_TRUE(planes.settled);
  EXPECT_LT(planes.steps, layers.steps);
}

TEST(Settle, AShortLimitIsReportedAsNotSettled) {
  const Pile pile = generate_pile(small_pile(23));
  SettleOptions options;
  options.layer_time_limit = 0.2;
  options.final_time_limit = 0.2;
  const PileState state = settle_pile(pile, options);
  EXPECT_FALSE(state.settled);
  EXPECT_EQ(state.layers_at_limit, 2);
  EXPECT_NEAR(state.simulated, 0.4, 0.02);
  bool moving = false;
  for (const PieceState& p : state.pieces) moving = moving || p.status == PieceStatus::moving;
  EXPECT_TRUE(moving);
}

TEST(Settle, PiecesThatLeaveTheWorldAreCounted) {
  Pile pile;
  pile.types = {testing::box_type("b", 0.3, 0.3, 0.3), testing::box_type("ramp", 8, 4, 0.5)};
  pile.placed = {testing::at(1, {0, 0, 3}, testing::turned({0, 1, 0}, 0.9), true).placement};
  pile.layers.resize(1);
  pile.layers[0].pieces = {testing::at(0, {-0.5, 0, 0.3}).placement,
                           testing::at(0, {-40, 0, 0.3}).placement};
  SettleOptions options;
  options.lost_beyond = 2.0;
  const PileState state = settle_pile(pile, options);
  EXPECT_EQ(state.lost, 2);
  EXPECT_EQ(state.pieces[0].status, PieceStatus::fixed);
  EXPECT_EQ(state.pieces[1].status, PieceStatus::lost);
  EXPECT_TRUE(state.settled);
}

TEST(Settle, LayersStartOneMetreAboveThePile) {
  Pile pile;
  pile.types = {testing::box_type("b", 0.2, 0.2, 0.2), testing::box_type("wall", 3, 0.3, 2.5)};
  pile.placed = {testing::at(1, {0, 2, 1.25}, {}, true).placement};
  pile.layers.resize(1);
  pile.layers[0].pieces = {testing::at(0, {0, 0, 0.1}).placement};
  SettleOptions options;
  options.final_time_limit = 0.1;
  double first_z = 0;
  const PileState state = settle_pile(pile, options);
  first_z = state.pieces[1].world_from_body.translation.z;
  EXPECT_NEAR(first_z, 2.5 + 1 + 0.1 - 0.5 * 9.81 * 0.1 * 0.1, 1e-6);
}

TEST(Settle, LoosePlacedPiecesSettleFirst) {
  Pile pile;
  pile.types = {testing::box_type("b", 0.2, 0.2, 0.2)};
  pile.placed = {testing::at(0, {0, 0, 0.8}).placement};
  const PileState state = settle_pile(pile);
  EXPECT_TRUE(state.settled);
  EXPECT_NEAR(state.pieces[0].world_from_body.translation.z, 0.1, 0.002);
  EXPECT_EQ(state.pieces[0].layer, -1);
}

TEST(Settle, TheCallbackHearsWhenRestIsVerified) {
  const Pile pile = generate_pile(small_pile(24));
  int verifying = 0;
  bool falling = false, went_back = false;
  const PileState state = settle_pile(pile, {}, [&](const SettleProgress& p) {
    EXPECT_TRUE(!p.verifying || p.layer == p.layers);
    went_back = went_back || (verifying > 0 && !p.verifying);
    p.verifying ? void(++verifying) : void(falling = true);
    return true;
  });
  EXPECT_TRUE(state.settled && falling);
  EXPECT_GE(verifying, 30) << "half a second";
  EXPECT_FALSE(went_back);
}

TEST(Settle, TheCallbackCanStopIt) {
  const Pile pile = generate_pile(small_pile(24));
  int calls = 0;
  const PileState state = settle_pile(pile, {}, [&](const SettleProgress& p) {
    EXPECT_EQ(p.layers, 2);
    EXPECT_LE(p.awake, p.pieces);
    return ++calls < 10;
  });
  EXPECT_EQ(calls, 10);
  EXPECT_EQ(state.steps, 10);
  EXPECT_FALSE(state.settled);
}

TEST(Settle, OptionsAreChecked) {
  SettleOptions options;
  options.step = 1;
  options.threads = -1;
  try {
    options.validate();
    FAIL() << "no error";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2u);
    EXPECT_EQ(error.diagnostics()[0].key, "step");
    EXPECT_EQ(error.diagnostics()[1].key, "threads");
  }
}

TEST(Settle, AnEmptyPileIsAtRest) {
  EXPECT_TRUE(settle_pile(Pile{}).settled);
}

// A piece whose corners are 3 m from the origin of its file, which comes to lie below the ground or above it.
TEST(Settle, APieceFarFromItsOriginIsNotLost) {
  PieceType type = testing::box_type("stone", 0.6, 0.5, 0.4);
  for (Vec3& p : type.parts[0].points) p += Vec3{3, 2, 1};
  PileSpec spec;
  spec.seed = 1;
  spec.types = {type};
  spec.mix = {{0, 1, 1, 1}};
  spec.layers = 1, spec.pieces_per_layer = 8;
  spec.spawn_bounds = {6, 6, 3};
  const PileState state = settle_pile(generate_pile(spec), SettleOptions{});
  EXPECT_EQ(state.lost, 0);
  EXPECT_TRUE(state.settled);
}

}  // namespace settle_test
}  // namespace rubble
