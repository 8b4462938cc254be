// A building that has collapsed, laid into a world where it can move again: what holds together and what hangs.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kernel/base/error.h"
#include "kernel/robot/robot_run.h"
#include "kernel/settling/building_collapse.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_structures.h"
#include "robot_scenes.h"
#include "scenes.h"

namespace rubble {
namespace laid_building_test {

constexpr double kGravity = 9.81;

PieceType make_box(const Vec3& size, double density) {
  PieceType type = testing::box_type("box", size.x, size.y, size.z);
  type.density = density;
  return type;
}

struct Ruin {
  Pile pile;
  PileState state;
};

// Under a fixed beam hangs a box of 100 kg by a bar of a metre; beside it, two boxes that hold together as a bar
// of 4 m lie on the ground, only the first of them on the brick under it, so that the second is in the air.
Ruin make_ruin() {
  Ruin r;
  r.pile.types = {make_box({0.2, 0.2, 0.2}, 12500), make_box({1, 1, 0.2}, 2400), make_box({2, 0.4, 0.2}, 2400),
                  make_box({1, 0.4, 0.1}, 2400)};
  r.pile.building.storeys = 1;
  r.pile.placed = {{3, 1, {{}, {2.9, 0, 0.05}}, true}};
  const auto add = [&](int type, const Vec3& at, PieceStatus status) {
    PieceState piece;
    piece.type = type, piece.layer = -1, piece.status = status;
    piece.world_from_body.translation = at;
    r.state.pieces.push_back(piece);
  };
  add(3, {2.9, 0, 0.05}, PieceStatus::fixed);
  add(1, {0, 0, 5.1}, PieceStatus::fixed);
  add(0, {0, 0, 4}, PieceStatus::resting);
  add(2, {3, 0, 0.2}, PieceStatus::resting);
  add(2, {5, 0, 0.2}, PieceStatus::resting);
  r.state.building.first = 1, r.state.building.count = 4;
  r.state.building.bodies = {{3, 4}};
  r.state.building.ties = {{1, 2, {0, 0, -0.1}, {}, 1, 1e5, 0.1}};
  r.state.settled = true;
  return r;
}

double moved(const World& world, const PileState& state, int piece) {
  return distance(world.piece(piece).world_from_body.translation,
                  state.pieces[std::size_t(piece)].world_from_body.translation);
}

TEST(LaidBuilding, WhatHangsHangsAndSleeps) {
  const Ruin r = make_ruin();
  World world(r.pile.types);
  world.lay(r.pile, r.state);
  ASSERT_EQ(world.structures().tie_count(), 1);
  EXPECT_EQ(world.structures().ties()[0].stretch, 0.1);
  EXPECT_EQ(world.structures().ties()[0].length, 1);
  EXPECT_EQ(world.awake_count(), 0);
  EXPECT_NEAR(world.structures().tie_force(0) / (world.mass(2) * kGravity), 1, 0.02);
  world.set_step(1.0 / 240, 4);
  for (int i = 0; i < 240; ++i) world.step();
  world.wake_all();
  for (int i = 0; i < 240; ++i) world.step();
  EXPECT_LT(moved(world, r.state, 2), 0.003);
  EXPECT_EQ(world.structures().tie_count(), 1);
}

TEST(LaidBuilding, ATieThatIsNotLaidLetsItFall) {
  Ruin r = make_ruin();
  r.state.building.ties.clear();
  World world(r.pile.types);
  world.lay(r.pile, r.state);
  world.wake_all();
  for (int i = 0; i < 30; ++i) world.step();
  EXPECT_GT(moved(world, r.state, 2), 0.5);
}

// A block of 20 kg between two posts: nothing but the force that they press it with holds it, and no pose says how large that is.
TEST(LaidBuilding, WhatIsWedgedStaysByTheLoadsThatTheStateHas) {
  Ruin r;
  r.pile.types = {make_box({0.2, 0.2, 0.2}, 2500), make_box({0.2, 0.4, 3}, 2400)};
  for (PieceType& type : r.pile.types) type.friction = 0.15;
  r.pile.building.storeys = 1;
  for (const double x : {-0.2, 0.0, 0.2}) {
    PieceState piece;
    piece.type = x == 0 ? 0 : 1, piece.layer = -1;
    piece.status = x == 0 ? PieceStatus::resting : PieceStatus::fixed;
    piece.world_from_body.translation = {x, 0, x == 0 ? 2.0 : 1.5};
    r.state.pieces.push_back(piece);
  }
  r.state.building.first = 0, r.state.building.count = 3;
  r.state.settled = true;
  for (const float side : {-1.0F, 1.0F})
    for (const float y : {-0.1F, 0.1F})
      for (const float z : {1.9F, 2.1F})
        r.state.building.loads.push_back({1, side < 0 ? 0 : 2, {0.1F * side, y, z}, {-200 * side, 0, float(20 * kGravity) / 8}});
  const auto fall = [&r] {
    World world(r.pile.types);
    world.lay(r.pile, r.state);
    world.set_step(1.0 / 240, 4);
    world.set_sleeping(false);
    for (int i = 0; i < 240; ++i) world.step();
    return moved(world, r.state, 1);
  };
  EXPECT_LT(fall(), 1e-3);
  r.state.building.loads.clear();
  EXPECT_GT(fall(), 0.5);
}

TEST(LaidBuilding, WhatHoldsTogetherMovesAsOne) {
  const Ruin r = make_ruin();
  World world(r.pile.types);
  world.lay(r.pile, r.state);
  EXPECT_EQ(world.structures().bound_with(4), (std::vector<int>{3, 4}));
  const double mass = world.mass(3);
  EXPECT_NEAR(mass, 2 * 2 * 0.4 * 0.2 * 2400, 1e-6);
  EXPECT_LT(moved(world, r.state, 4), 1e-9) << "laid where it was";
  world.wake_all();
  for (int i = 0; i < 60; ++i) world.step();  // it tips over the brick: the heavier end is in the air
  EXPECT_GT(moved(world, r.state, 4), 0.02);
  const Pose a = world.piece(3).world_from_body, b = world.piece(4).world_from_body;
  const Vec3 along = a.rotation.conjugate().rotate(b.translation - a.translation);
  EXPECT_NEAR(distance(along, {2, 0, 0}), 0, 1e-9);
  const Vec3 before = world.diagnostics().linear_momentum();
  world.set_velocity(4, world.structures().centre_velocity(4) + Vec3{0, 1, 0}, {});
  EXPECT_NEAR(world.diagnostics().linear_momentum().y - before.y, mass, mass * 1e-6) << "a push on one moves both";
}

TEST(LaidBuilding, WhatIsAnchoredStands) {
  Ruin r = make_ruin();
  for (const std::size_t i : {3u, 4u}) r.state.pieces[i].status = PieceStatus::fixed;
  World world(r.pile.types);
  world.lay(r.pile, r.state);
  world.wake_all();
  for (int i = 0; i < 60; ++i) world.step();
  EXPECT_EQ(moved(world, r.state, 4), 0);
  EXPECT_EQ(world.piece(4).status, PieceStatus::fixed);
}

TEST(LaidBuilding, RefusesAStateThatCannotBe) {
  const auto error = [](const std::function<void(Ruin&)>& change) {
    Ruin r = make_ruin();
    change(r);
    try {
      World(r.pile.types).lay(r.pile, r.state);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(error([](Ruin&) {}), "");
  EXPECT_NE(error([](Ruin& r) { r.state.building = {}; }).find("which pieces of the building hold together"),
            std::string::npos);
  EXPECT_NE(error([](Ruin& r) { r.pile.building = {}; }), "");
  EXPECT_NE(error([](Ruin& r) { r.pile.placed.clear(); }), "");
  EXPECT_NE(error([](Ruin& r) { r.state.pieces.pop_back(); }), "");
  EXPECT_NE(error([](Ruin& r) { r.state.building.bodies = {{0, 3}}; }), "");
  EXPECT_NE(error([](Ruin& r) { r.state.building.bodies = {{4, 3}}; }), "");
  EXPECT_NE(error([](Ruin& r) { r.state.building.bodies = {{2, 3}, {3, 4}}; }), "");
  EXPECT_NE(error([](Ruin& r) { r.state.pieces[3].status = PieceStatus::fixed; }), "");
  EXPECT_NE(error([](Ruin& r) { r.state.pieces[3].world_from_body.rotation = {0, 1, 0, 0}; }), "");
  EXPECT_NE(error([](Ruin& r) { r.state.building.ties[0].strength = 0; }), "");
}

// A storey whose columns give way, with bars that hold on: what it came to is laid, and stays.
TEST(LaidBuilding, ACollapsedStoreyStaysAsItCameToRest) {
  PileSpec spec;
  spec.layers = 0;
  BuildingSpec& b = spec.building;
  b.storeys = b.bays_x = b.bays_y = 1;
  b.piece = 1.6, b.continuity = 0.3;
  b.cause.weak_storey = 0, b.cause.weakness = 0.05;
  spec.types = make_building_types(b);
  const Pile pile = generate_pile(spec);
  const PileState state = settle_pile(pile);
  ASSERT_EQ(state.building.count, int(state.pieces.size()));
  ASSERT_FALSE(state.building.bodies.empty());
  World world(pile.types);
  world.lay(pile, state);
  EXPECT_EQ(world.structures().tie_count(), int(state.building.ties.size()));
  EXPECT_EQ(world.awake_count(), 0);
  for (int i = 0; i < 60; ++i) world.step();
  for (int i = 0; i < world.size(); ++i) EXPECT_LT(moved(world, state, i), 1e-9) << i;
  // A robot in the world beside it changes nothing of what it does not touch.
  RobotRunOptions options;
  options.duration = 0.5, options.threads = 1;
  RobotRun run(pile, state, options);
  run.add(make_crawler(), {{}, {-7, 0, 0.002}}, [](const RobotSense&) { return RobotCommand(); });
  EXPECT_EQ(run.run().pieces_moved, 0);
}

}  // namespace laid_building_test
}  // namespace rubble
