// Footings that sink: what stands on them goes down with them, and what the rest of the building holds up does not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/settling/building_collapse.h"
#include "kernel/settling/settle.h"
#include "kernel/structure/building.h"
#include "kernel/structure/failure.h"
#include "building_scenes.h"

namespace rubble {
namespace sinking_test {

using testing::pile_of;
using testing::small_building;

PileState settle(const BuildingSpec& building) {
  SettleOptions options;
  options.threads = 2;
  options.final_time_limit = 40;
  return settle_pile(pile_of(building), options);
}

// How far each piece has gone down; unit: m.
std::vector<double> lowered(const BuildingSpec& building, const PileState& state) {
  const Structure before = build_structures(building).damaged;
  std::vector<double> result;
  for (std::size_t i = 0; i < before.pieces.size(); ++i) {
    result.push_back(before.pieces[i].position.z - state.pieces[i].world_from_body.translation.z);
  }
  return result;
}

TEST(Sinking, CutsFootingsAsHighAsTheyWillSinkAndNothingElse) {
  BuildingSpec b = small_building();
  b.cause.sinking = {{0, 0, 0.4, {}}, {1, 1, 0.004, {}}};
  const auto members = list_members(b);
  double plain = 0, cut = 0;
  for (const Member& m : members) {
    cut += m.size.x * m.size.y * m.size.z;
    if (!m.place.footing) continue;
    EXPECT_EQ(m.centre.z, m.size.z / 2);
    EXPECT_NEAR(m.size.z, m.place.i == 0 ? 0.4 : 0.1, 1e-12) << m.name;  // one of millimetres is no sliver
  }
  b.cause.sinking.clear();
  for (const Member& m : list_members(b)) plain += m.size.x * m.size.y * m.size.z;
  EXPECT_NEAR(cut / plain, 1, 1e-9);
  EXPECT_EQ(members.size(), list_members(b).size() + 2);
}

TEST(Sinking, ABuildingGoesDownAsAWholeWithAllOfItsFootings) {
  BuildingSpec b = small_building();
  b.cause.sinking = {{0, 0, 0.4, {}}, {1, 0, 0.4, {}}, {0, 1, 0.4, {}}, {1, 1, 0.4, {}}};
  const PileState state = settle(b);
  EXPECT_TRUE(state.settled);
  for (const double down : lowered(b, state)) EXPECT_NEAR(down, 0.4, 1e-9);
  for (const PieceState& piece : state.pieces) EXPECT_EQ(piece.status, PieceStatus::fixed);
}

// Of one column the frame has no need.
TEST(Sinking, WhatTheFrameHoldsUpHangsAndStays) {
  BuildingSpec b = small_building();
  b.bays_x = b.bays_y = 2;
  b.cause.sinking = {{0, 0, 0.5, {}}};
  const PileState state = settle(b);
  EXPECT_TRUE(state.settled);
  for (const double down : lowered(b, state)) EXPECT_NEAR(down, 0, 1e-9);
}

// The same bits on any number of threads, and nothing deeper in the ground than its footing sank.
TEST(Sinking, AHouseOfBricksComesDownOverItsSinkingSide) {
  BuildingSpec b = small_building();
  b.kind = BuildingKind::masonry;
  b.infill = Infill::brick;
  b.storeys = 3, b.bays_x = 2;
  b.span_x = b.span_y = 5;
  b.cause.sinking = {{0, 0, 0.5, {}}, {0, 1, 0.5, {}}};
  const PileState state = settle(b);
  EXPECT_TRUE(state.settled);
  EXPECT_LT(state.deepest_overlap.depth, 0.005);
  const Structure before = build_structures(b).damaged;
  const std::vector<double> down = lowered(b, state);
  int fell = 0, sank = 0;
  for (std::size_t i = 0; i < down.size(); ++i) {
    if (before.members[before.pieces[i].member].place.footing) {
      EXPECT_GE(down[i], -1e-9);
      EXPECT_LE(down[i], 0.5 + 1e-9);
      EXPECT_EQ(state.pieces[i].status, PieceStatus::fixed);
      sank += down[i] > 0.499;
    } else {
      fell += down[i] > 0.1;
    }
  }
  EXPECT_GT(sank, 0);
  EXPECT_GT(fell, int(down.size()) / 4);
  SettleOptions alone;
  alone.threads = 1;
  alone.final_time_limit = 40;
  EXPECT_EQ(settle_pile(pile_of(b), alone).state_hash(), state.state_hash());
}

// Nothing ties a precast beam to its seat: it comes off when its column goes down.
TEST(Sinking, PrecastBeamsComeOffTheSeatsOfASinkingColumn) {
  BuildingSpec b;
  b.kind = BuildingKind::precast;
  b.storeys = 2, b.bays_x = b.bays_y = 2;
  b.piece = 1.3, b.seed = 4;
  b.cause.sinking = {{0, 0, 0.3, {}}};
  const PileState state = settle(b);
  EXPECT_TRUE(state.settled);
  const Structure before = build_structures(b).damaged;
  const std::vector<double> down = lowered(b, state);
  int beams = 0;
  for (std::size_t i = 0; i < down.size(); ++i) {
    const Member& member = before.members[before.pieces[i].member];
    if (member.place.footing) {
      EXPECT_NEAR(down[i], 0.3, 1e-9);
    }
    beams += member.kind == MemberKind::beam && down[i] > 1;
  }
  EXPECT_GT(beams, 0);
}

// What goes down with its footings arrives: a rest of the way that is only rounding woke the pile in each step.
TEST(Sinking, RestsAtEveryDepth) {
  BuildingSpec b;
  b.kind = BuildingKind::bridge;
  b.storeys = b.bays_y = 1, b.bays_x = 2;
  b.span_x = b.span_y = 3;
  for (const double piece : {1.2, 1.6}) {
    for (const double depth : {0.15, 0.2, 0.3, 0.4, 0.45, 0.5}) {
      b.piece = piece;
      b.cause.sinking = {{1, 0, depth, {}}, {1, 1, depth, {}}};
      const PileState state = settle(b);
      EXPECT_TRUE(state.settled) << piece << " " << depth;
      EXPECT_LT(state.simulated, 20) << piece << " " << depth;
    }
  }
}

}  // namespace sinking_test
}  // namespace rubble
