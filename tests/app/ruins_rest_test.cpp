// Buildings that have come down rest: nothing moves when all pieces are awake.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/assets/asset_library.h"
#include "app/scene/build_scene.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world.h"
#include "scripting/mission.h"

namespace rubble {
namespace ruins_rest_test {

struct Settled {
  Mission mission;
  AssetLibrary assets;
  Pile pile;
  World world;
  PileState state;
};

Settled settle(const std::string& ruin, std::uint64_t seed) {
  MissionOptions changes;
  changes.seed = seed;
  const Mission mission = load_mission(RUBBLE_SOURCE_DIR "/scripts/ruins/" + ruin + ".lua", changes);
  const AssetLibrary assets = load_assets(mission, {});
  const Pile pile = generate_pile(build_pile_spec(mission.scenario.pile, seed, assets));
  World world(pile.types, calc_world_options(mission.scenario.settle), pile.assemblies);
  const PileState state = settle_pile(world, pile, mission.scenario.settle, [](const SettleProgress&) { return true; });
  EXPECT_TRUE(state.settled) << ruin;
  return {mission, assets, pile, std::move(world), state};
}

// How far a piece goes in so many steps awake; unit: m.
double drift_of(World& world, const PileState& state, int steps) {
  world.set_sleeping(false);
  for (int i = 0; i < steps; ++i) world.step();
  double farthest = 0;
  for (int i = 0; i < world.size(); ++i)
    farthest = std::max(farthest, distance(world.piece(i).world_from_body.translation,
                                           state.pieces[std::size_t(i)].world_from_body.translation));
  return farthest;
}

TEST(RuinsRest, WhatHangsOnBarsDoesNotCreep) {
  for (const char* ruin : {"car_park", "precast_deck"}) {
    Settled found = settle(ruin, 7);
    EXPECT_LT(drift_of(found.world, found.state, 240), 0.005) << ruin;
  }
}

// Robots drive in steps of 1/240 s in a world into which the ruin was laid.
TEST(RuinsRest, ARuinThatIsLaidForRobotsStaysWhenItWakes) {
  for (const char* ruin : {"planned_house", "precast_deck"}) {
    const Settled found = settle(ruin, 7);
    World laid(found.pile.types, calc_world_options(found.mission.scenario.settle), found.pile.assemblies);
    laid.lay(found.pile, found.state);
    laid.set_step(1.0 / 240, 4);
    EXPECT_LT(drift_of(laid, found.state, 960), 0.005) << ruin;
  }
}

}  // namespace ruins_rest_test
}  // namespace rubble
