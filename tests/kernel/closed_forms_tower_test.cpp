// Towers of bricks: the middle of all that is above lies over the middle of each, so they stand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "closed_forms.h"
#include "kernel/base/random.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {
namespace closed_forms_tower_test {

using namespace testing;

// Bricks of 215 x 102.5 x 65 mm, flat on each other. With `mess`, each is up to 3 mm and 3 degrees
// off: no joint is loaded more than 6 mm off its middle, where it would open at 17.
World make_tower(int bricks, bool sleeping, bool mess) {
  WorldOptions options;
  options.sleeping = sleeping;
  World world({box_type("brick", 0.215, 0.1025, 0.065)}, options);
  RandomStream random(5, "tower");
  std::vector<NewPiece> pieces;
  for (int i = 0; i < bricks; ++i) {
    const double x = random.uniform(-0.003, 0.003), y = random.uniform(-0.003, 0.003);
    const double yaw = random.uniform(-0.05, 0.05);
    const Vec3 p{mess ? x : 0, mess ? y : 0, 0.0325 + 0.0652 * i};
    pieces.push_back(at(0, p, mess ? turned({0, 0, 1}, yaw) : Quat{}));
  }
  world.add(pieces);
  return world;
}

// Farthest that any brick went sideways from where it was put, and down per joint below it.
struct Change {
  double drift = 0, sunk = 0;  // unit: m
};
Change measure_change(int bricks, double seconds, bool sleeping, bool mess) {
  World world = make_tower(bricks, sleeping, mess);
  const World start = make_tower(bricks, sleeping, mess);
  run(world, seconds);
  Change change;
  for (int i = 0; i < bricks; ++i) {
    const Vec3 moved =
        world.piece(i).world_from_body.translation - start.piece(i).world_from_body.translation;
    change.drift = std::max(change.drift, std::hypot(moved.x, moved.y));
    change.sunk = std::max(change.sunk, -moved.z / (i + 1));
  }
  return change;
}

void expect_to_stand(int bricks, double seconds, bool sleeping, double drift) {
  for (const bool mess : {false, true}) {
    const Change change = measure_change(bricks, seconds, sleeping, mess);
    EXPECT_LT(change.drift, drift) << (mess ? "laid roughly" : "aligned");
    EXPECT_LT(change.sunk, 0.0015) << (mess ? "laid roughly" : "aligned");  // a joint's slack
  }
}

TEST(ClosedFormTower, TwentyBricksStandAwakeForTenSeconds) {
  expect_to_stand(20, 10, false, 0.003);
}

TEST(NightlyClosedFormTower, ThirtyBricksStandAwakeForAMinute) { expect_to_stand(30, 60, false, 0.004); }

// Plates that lie on each other turned at random: their common surface has up to eight corners, of which a contact keeps
// six. The same six in each step, or the load of those that go and come shakes the stack.
TEST(ClosedFormTower, PlatesTurnedAtRandomStandAwake) {
  struct Stack {
    int plates;
    double thickness;
  };
  for (const Stack& stack : {Stack{10, 0.2}, Stack{15, 0.05}, Stack{20, 0.2}, Stack{40, 0.018}}) {
    WorldOptions options;
    options.sleeping = false;
    World world({box_type("plate", 1.2, 0.8, stack.thickness)}, options);
    RandomStream random(7, "stack");
    std::vector<NewPiece> pieces;
    for (int i = 0; i < stack.plates; ++i) {
      const double yaw = random.uniform(0, 6.28), x = random.uniform(-0.05, 0.05), y = random.uniform(-0.05, 0.05);
      pieces.push_back(at(0, {x, y, stack.thickness * (i + 0.5) + 0.001 * (i + 1)}, turned({0, 0, 1}, yaw)));
    }
    world.add(pieces);
    run(world, 3);
    std::vector<Vec3> before;
    for (int i = 0; i < stack.plates; ++i) before.push_back(world.piece(i).world_from_body.translation);
    run(world, 10);
    for (int i = 0; i < stack.plates; ++i)
      EXPECT_LT(distance(world.piece(i).world_from_body.translation, before[std::size_t(i)]), 0.001) << stack.thickness << " " << i;
    EXPECT_LT(world.diagnostics().kinetic_energy(), 1e-6) << stack.thickness;
  }
}

TEST(ClosedFormTower, ThirtyBricksStandForAMinuteAndSleep) {
  expect_to_stand(30, 60, true, 0.004);
  for (const bool mess : {false, true}) {
    World world = make_tower(30, true, mess);
    run(world, 20);
    EXPECT_EQ(world.awake_count(), 0) << (mess ? "laid roughly" : "aligned");
  }
}

}  // namespace closed_forms_tower_test
}  // namespace rubble
