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

// How far a piece goes in 4 s awake; unit: m.
double drift_of(const std::string& ruin, std::uint64_t seed) {
  MissionOptions changes;
  changes.seed = seed;
  const Mission mission = load_mission(RUBBLE_SOURCE_DIR "/scripts/ruins/" + ruin + ".lua", changes);
  const AssetLibrary assets = load_assets(mission, {});
  const Pile pile = generate_pile(build_pile_spec(mission.scenario.pile, seed, assets));
  World world(pile.types, calc_world_options(mission.scenario.settle), pile.assemblies);
  const PileState state = settle_pile(world, pile, mission.scenario.settle, [](const SettleProgress&) { return true; });
  EXPECT_TRUE(state.settled) << ruin;
  world.set_sleeping(false);
  for (int i = 0; i < 240; ++i) world.step();
  double farthest = 0;
  for (int i = 0; i < world.size(); ++i)
    farthest = std::max(farthest, distance(world.piece(i).world_from_body.translation,
                                           state.pieces[std::size_t(i)].world_from_body.translation));
  return farthest;
}

TEST(RuinsRest, WhatHangsOnBarsDoesNotCreep) {
  for (const char* ruin : {"car_park", "precast_deck"}) EXPECT_LT(drift_of(ruin, 7), 0.005) << ruin;
}

}  // namespace ruins_rest_test
}  // namespace rubble
