// The maps of robots that explore: OctoMap's tree behind our interface, and where a map has room for a robot.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/search/exploration_map.h"
#include "io/voids/occupancy_octree.h"

namespace rubble::testing {
namespace explore_test {

// Rays from the middle of cell (0, 0, 0) along X, to the middle of cell (`cells`, 0, 0).
std::vector<OccupancyOctree::Change> look_along_x(OccupancyOctree& tree, int cells, double max_range = 5) {
  return tree.insert({0.05, 0.05, 0.05}, {{0.05 + 0.1 * cells, 0.05, 0.05}}, max_range);
}

TEST(OccupancyOctree, CellsOfARayAreFreeAndItsEndIsSolid) {
  OccupancyOctree tree(0.1);
  const auto changes = look_along_x(tree, 10);
  ASSERT_EQ(changes.size(), 11u);
  for (int x = 0; x <= 10; ++x) {
    EXPECT_EQ(changes[std::size_t(x)].cell, (Cell{x, 0, 0}));
    EXPECT_EQ(changes[std::size_t(x)].occupied, x == 10);
  }
  EXPECT_TRUE(look_along_x(tree, 10).empty()) << "nothing has changed";
}

TEST(OccupancyOctree, ARayThatIsCutHitsNothing) {
  OccupancyOctree tree(0.1);
  const auto changes = look_along_x(tree, 40, 1.0);
  ASSERT_FALSE(changes.empty());
  EXPECT_EQ(changes.back().cell, (Cell{9, 0, 0}));
  for (const auto& change : changes) EXPECT_FALSE(change.occupied);
}

// ln(0.7 / 0.3) = 0.847 of a hit, ln(0.4 / 0.6) = -0.405 of a miss: the third miss takes a hit back.
TEST(OccupancyOctree, WhatIsMissedThriceAfterAHitIsFree) {
  OccupancyOctree tree(0.1);
  look_along_x(tree, 10);
  const auto flips = [&] {
    const auto changes = look_along_x(tree, 20);
    return std::any_of(changes.begin(), changes.end(), [](const auto& c) { return c.cell[0] == 10 && !c.occupied; });
  };
  EXPECT_FALSE(flips());
  EXPECT_FALSE(flips());
  EXPECT_TRUE(flips());
  EXPECT_FALSE(flips()) << "it was free before";
  // It stands at 0.847 - 4 * 0.405 = -0.774: one hit makes it solid again.
  const auto back = look_along_x(tree, 10);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_TRUE(back.front().cell[0] == 10 && back.front().occupied);
}

TEST(OccupancyOctree, TheOrderOfPointsChangesNothing) {
  std::vector<Vec3> points;
  for (int i = 0; i < 200; ++i) points.push_back({1 + 0.013 * (i % 17), 0.021 * (i % 29) - 0.3, 0.017 * (i % 13)});
  OccupancyOctree one(0.1), other(0.1);
  for (int scan = 0; scan < 3; ++scan) {
    const auto a = one.insert({0, 0, 0.5}, points, 5);
    std::reverse(points.begin(), points.end());
    const auto b = other.insert({0, 0, 0.5}, points, 5);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(scan == 0, a.size() > 20);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].cell, b[i].cell);
      EXPECT_EQ(a[i].occupied, b[i].occupied);
    }
  }
}

SearchBriefing briefing() {
  SearchBriefing b;
  b.bounds.include({-1, -1, 0}), b.bounds.include({2, 1, 1.5});
  return b;
}

TEST(ExplorationMap, HasRoomWhereNothingSolidIsNearAndAgainWhenItIsGone) {
  ExplorationMap map(briefing());
  const VoxelGrid& grid = map.grid();
  for (int x = 0; x < grid.size[0]; ++x)
    for (int y = 0; y < grid.size[1]; ++y)
      for (int z = 0; z < grid.size[2]; ++z) map.set_free_if_unknown({x, y, z});
  const Vec3 place{0.55, 0.05, 0.75};
  const std::size_t here = map.find(place);
  EXPECT_TRUE(map.is_way(here));
  EXPECT_FALSE(map.is_way(map.find({0.55, 0.05, 0.05}))) << "the ground is nearer than the robot's radius";
  const Cell beside = grid.find_cell(place + Vec3{0.1, 0, 0}), farther = grid.find_cell(place + Vec3{0.3, 0, 0});
  map.set(farther, ExplorationMap::kSolid);
  EXPECT_TRUE(map.is_way(here));
  map.set(beside, ExplorationMap::kSolid), map.set(beside, ExplorationMap::kSolid);
  EXPECT_FALSE(map.is_way(here));
  map.set(beside, ExplorationMap::kFree);
  EXPECT_TRUE(map.is_way(here));
  EXPECT_TRUE(map.has_roof(map.find(grid.centre(farther) - Vec3{0, 0, 0.4})));
  EXPECT_FALSE(map.has_roof(here));
  map.block(here);
  EXPECT_FALSE(map.is_way(here));
}

// A picture of a wall 1 m ahead: both ways of mapping know what is before it, that it is solid, and nothing behind it.
TEST(DepthMapping, BothWaysSeeAWallAndWhatIsBeforeIt) {
  for (const bool octomap : {false, true}) {
    const SearchBriefing b = briefing();
    ExplorationMap map(b);
    SearchObservation seen;
    seen.pose.position = {0.05, 0.05, 0.65};
    seen.depth.assign(std::size_t(b.rules.width) * std::size_t(b.rules.height), 1.03f);
    (octomap ? make_octomap_mapping : make_ray_mapping)(b.rules)(seen, map);
    const auto state = [&](double x) { return map.state(map.find({x, 0.05, 0.65})); };
    EXPECT_EQ(state(0.55), ExplorationMap::kFree) << octomap;
    EXPECT_EQ(state(1.05), ExplorationMap::kSolid) << octomap;
    EXPECT_EQ(state(1.25), ExplorationMap::kUnknown) << octomap;
    EXPECT_EQ(state(-0.15), ExplorationMap::kUnknown) << octomap;
    EXPECT_TRUE(map.borders_unknown(map.find({1.05, 0.05, 0.65}))) << octomap;
    EXPECT_FALSE(map.borders_unknown(map.find({0.85, 0.05, 0.65}))) << octomap;
  }
}

}  // namespace explore_test
}  // namespace rubble::testing
