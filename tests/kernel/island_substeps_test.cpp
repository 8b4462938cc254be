// Islands that are high for their number of contacts are solved apart, in more substeps.
#include "kernel/solver/island_substeps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/world/world_diagnostics.h"
#include "scenes.h"

namespace rubble {
namespace island_substeps_test {

using namespace testing;

constexpr std::size_t kNoTies = 100000;

// Bodies and contacts, bottom up.
struct Bodies {
  std::vector<Body> bodies;
  std::vector<Contact> contacts;
  std::vector<std::int32_t> order;

  std::int32_t add(bool awake = true) {
    bodies.emplace_back();
    bodies.back().awake = awake;
    return std::int32_t(bodies.size()) - 1;
  }
  void touch(std::int32_t a, std::int32_t b) {
    contacts.emplace_back();
    contacts.back().body_a = a, contacts.back().body_b = b;
    order.push_back(std::int32_t(order.size()));
  }
  // A column from the ground up; returns its lowest body.
  std::int32_t add_column(int height) {
    const auto first = std::int32_t(bodies.size());
    for (int i = 0; i < height; ++i) touch(add(), i == 0 ? kGround : first + i - 1);
    return first;
  }
  IslandSubsteps split(std::size_t ties = kNoTies) const {
    IslandSubsteps islands;
    ThreadPool pool(1);
    islands.split(bodies, contacts, ties, order, pool);
    return islands;
  }
};

constexpr int kHeap = IslandSubsteps::kHeap;
constexpr IslandKind kColumn = kIslandKinds[0], kStack = kIslandKinds[1];

TEST(IslandSubsteps, HighIslandsHaveMore) {
  Bodies scene;
  const std::int32_t low = scene.add_column(kStack.height - 1);
  EXPECT_EQ(scene.split().kind_of(low), kHeap);
  const std::int32_t column = scene.add_column(kColumn.height), stack = scene.add_column(kStack.height);
  const int wide = kColumn.contacts * kStack.height + 1;
  for (int contacts = kStack.height; contacts < wide; ++contacts) scene.touch(scene.add(), stack);
  const IslandSubsteps islands = scene.split();
  EXPECT_EQ(islands.kind_of(low), kHeap);
  EXPECT_EQ(islands.kind_of(column), 0);
  EXPECT_EQ(islands.kind_of(stack), 1);
  EXPECT_EQ(islands.contacts(kHeap).size(), std::size_t(kStack.height) - 1);
  EXPECT_EQ(islands.contacts(0).size(), std::size_t(kColumn.height));
  EXPECT_EQ(islands.contacts(1).size(), std::size_t(wide));
  EXPECT_EQ(islands.contacts(0).front(), kStack.height - 1);
  EXPECT_TRUE(std::is_sorted(islands.contacts(1).begin(), islands.contacts(1).end()));
}

TEST(IslandSubsteps, WideIslandsHaveFewer) {
  Bodies scene;
  const std::int32_t column = scene.add_column(12);
  const auto widen_to = [&](int contacts) {
    while (int(scene.order.size()) < contacts) scene.touch(scene.add(), column);
  };
  widen_to(kColumn.contacts * 12);
  EXPECT_EQ(scene.split().kind_of(column), 0);
  widen_to(kColumn.contacts * 12 + 1);
  EXPECT_EQ(scene.split().kind_of(column), 1);
  widen_to(kStack.contacts * 12);
  EXPECT_EQ(scene.split().kind_of(column), 1);
  widen_to(kStack.contacts * 12 + 1);
  EXPECT_EQ(scene.split().kind_of(column), kHeap);
}

TEST(IslandSubsteps, WhatHasTiesIsAKindOfItsOwnAndWithLinksOfTreesAHeap) {
  Bodies scene;
  const std::int32_t column = scene.add_column(12);
  EXPECT_EQ(scene.split(12).kind_of(column), 0);
  EXPECT_EQ(scene.split(11).kind_of(column), IslandSubsteps::kTied);
  EXPECT_EQ(scene.split(11).contacts(IslandSubsteps::kTied).size(), 12U);
  scene.bodies.back().tree = 0;
  EXPECT_EQ(scene.split().kind_of(column), kHeap);
  EXPECT_EQ(scene.split(11).kind_of(column), kHeap);
}

TEST(IslandSubsteps, AreJoinedThroughWhatMovesOnly) {
  Bodies scene;
  const std::int32_t slab = scene.add(false);  // asleep, or fixed
  const auto stand_on_slab = [&](int height) {
    const auto first = std::int32_t(scene.bodies.size());
    for (int i = 0; i < height; ++i) scene.touch(scene.add(), i == 0 ? slab : first + i - 1);
    return first;
  };
  const std::int32_t one = stand_on_slab(12), other = stand_on_slab(4);
  const IslandSubsteps islands = scene.split();
  EXPECT_EQ(islands.kind_of(one), 0);
  EXPECT_EQ(islands.kind_of(other), kHeap);
  EXPECT_EQ(islands.contacts(0).size(), 12U);
}

World make_stack(bool heap) {
  WorldOptions options;
  options.sleeping = false;
  PieceType cube = box_type("cube", 0.1, 0.1, 0.1);
  cube.density = 100;
  World world({box_type("plate", 1.2, 0.8, 0.05), box_type("base", 6, 6, 0.1), cube}, options);
  std::vector<NewPiece> pieces{at(1, {0, 0, 0.051})};
  for (int i = 0; i < 14; ++i) pieces.push_back(at(0, {0.01 * (i % 3), 0, 0.127 + 0.051 * i}, turned({0, 0, 1}, 0.4 * i)));
  if (heap) pieces.push_back(at(2, {20, 0, 0.051}));
  world.add(pieces);
  return world;
}

// Its bits do not depend on what lies elsewhere.
TEST(IslandSubsteps, AStackMovesAlikeBesideAnotherIsland) {
  World alone = make_stack(false), beside = make_stack(true);
  for (int i = 0; i < 120; ++i) alone.step(), beside.step();
  for (int i = 0; i < 15; ++i) {
    const Vec3 p = alone.piece(i).world_from_body.translation, q = beside.piece(i).world_from_body.translation;
    EXPECT_TRUE(p.x == q.x && p.y == q.y && p.z == q.z) << i;
  }
}

// Cubes on its base make it wider, so that it is solved in fewer substeps: loads go on from where they were.
TEST(IslandSubsteps, WhatBecomesWiderIsNotShaken) {
  World world = make_stack(false);
  for (int i = 0; i < 240; ++i) world.step();
  const double before = world.piece(14).world_from_body.translation.z;
  ASSERT_LT(world.diagnostics().kinetic_energy(), 1e-6);
  std::vector<NewPiece> cubes;
  for (int i = 0; i < 2116; ++i) {
    const double x = -2.925 + 0.13 * (i % 46), y = -2.925 + 0.13 * (i / 46);
    if (std::abs(x) > 0.9 || std::abs(y) > 0.9) cubes.push_back(at(2, {x, y, 0.1521 + world.piece(0).world_from_body.translation.z - 0.051}));
  }
  ASSERT_GT(int(cubes.size()), kColumn.contacts * 16);
  world.add(cubes);
  double most = 0;
  for (int i = 0; i < 10; ++i) {
    world.step();
    for (int k = 1; k < 15; ++k) most = std::max(most, double(norm(world.piece(k).linear_velocity)));
  }
  EXPECT_LT(most, 0.001);  // 0.011 where impulses are not scaled; unit: m/s
  EXPECT_NEAR(world.piece(14).world_from_body.translation.z, before, 0.0005);
}

}  // namespace island_substeps_test
}  // namespace rubble
