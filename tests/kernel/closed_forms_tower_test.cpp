// Towers of bricks: the middle of all that is above lies over the middle of each, so they stand.
#include <gtest/gtest.h>

#include <cmath>

#include "closed_forms.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

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

// Farthest that any brick went sideways from where it was put; unit: m.
double measure_drift(int bricks, double seconds, bool sleeping, bool mess) {
  World world = make_tower(bricks, sleeping, mess);
  const World start = make_tower(bricks, sleeping, mess);
  run(world, seconds);
  double worst = 0;
  for (int i = 0; i < bricks; ++i) {
    const Vec3 moved =
        world.piece(i).world_from_body.translation - start.piece(i).world_from_body.translation;
    worst = std::max(worst, std::hypot(moved.x, moved.y));
    EXPECT_GT(moved.z, -0.0015 * (i + 1)) << "brick " << i;  // a joint's slack each, not a fall
  }
  return worst;
}

TEST(ClosedFormTower, TwentyBricksStandAwakeForTenSeconds) {
  for (const bool mess : {false, true}) {
    EXPECT_LT(measure_drift(20, 10, false, mess), 0.003) << (mess ? "laid roughly" : "aligned");
  }
}

TEST(ClosedFormTower, ThirtyBricksStandAwakeForAMinute) {
  for (const bool mess : {false, true}) {
    EXPECT_LT(measure_drift(30, 60, false, mess), 0.004) << (mess ? "laid roughly" : "aligned");
  }
}

TEST(ClosedFormTower, ThirtyBricksStandForAMinuteAndSleep) {
  for (const bool mess : {false, true}) {
    EXPECT_LT(measure_drift(30, 60, true, mess), 0.004) << (mess ? "laid roughly" : "aligned");
    World world = make_tower(30, true, mess);
    run(world, 20);
    EXPECT_EQ(world.awake_count(), 0);
  }
}

}  // namespace
}  // namespace rubble
