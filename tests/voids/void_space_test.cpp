// Voxels against closed forms and against exact queries.
#include "kernel/voids/void_space.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "kernel/queries/queries.h"
#include "void_scenes.h"

namespace rubble {
namespace void_space_test {

using testing::VoidScene;
constexpr double kPi = 3.14159265358979323846;

VoidSpaceOptions options_with(double voxel, double rolling) {
  VoidSpaceOptions options;
  options.voxel = voxel;
  options.rolling_radius = rolling;
  return options;
}

Pose turned(RandomStream& random, const Vec3& position) { return {random.rotation(), position}; }

TEST(VoidSpace, FillsASolidToItsVolume) {
  RandomStream random(1, "void space");
  for (int i = 0; i < 4; ++i) {
    VoidScene scene;
    scene.add(testing::make_box({-0.5, -0.3, -0.2}, {0.5, 0.3, 0.2}), turned(random, {0, 0, 1}));
    const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options_with(0.02, 0.3));
    EXPECT_NEAR(space.volume(CellKind::solid), 0.24, 0.24 * 0.005);
  }
}

TEST(VoidSpace, OverlappingSolidsCountOnce) {
  VoidScene scene;
  scene.add(testing::make_box({0, 0, 0}, {1, 1, 1}));
  scene.add(testing::make_box({0.5, 0, 0}, {1.5, 1, 1}));
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options_with(0.05, 0.3));
  EXPECT_NEAR(space.volume(CellKind::solid), 1.5, 1e-9);
}

TEST(VoidSpace, ClearanceIsTheExactDistanceWithinAFractionOfAVoxel) {
  RandomStream random(2, "void space");
  VoidScene scene;
  for (int i = 0; i < 12; ++i) {
    const Vec3 position{random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8),
                        random.uniform(0.2, 1)};
    scene.add(testing::make_box({-0.3, -0.2, -0.1}, {0.3, 0.2, 0.1}), turned(random, position));
  }
  const PileQueries exact(scene.pile, scene.pointers());
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options_with(0.04, 0.5));
  double worst = 0, mean = 0;
  int count = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::size_t cell = random.below(space.grid.count());
    const double expected = exact.clearance(space.grid.centre(cell));
    const double found = space.clearance[cell];
    if (expected == 0) {
      EXPECT_LT(found, 1e-3) << "inside of a solid";
      continue;
    }
    ASSERT_GT(found, expected - 1e-5) << "never less than the nearest surface";
    worst = std::max(worst, found - expected);
    mean += found - expected;
    ++count;
  }
  EXPECT_LT(worst, 0.3 * space.grid.voxel);
  EXPECT_LT(mean / count, 0.002 * space.grid.voxel);
}

// A ball of radius R at the mouth of a bore of radius a dips in by R - sqrt(R^2 - a^2); what it
// takes away is a cap of a ball.
double cap_volume(double ball, double bore) {
  const double depth = ball - std::sqrt(ball * ball - bore * bore);
  return kPi * depth * depth * (3 * ball - depth) / 3;
}

TEST(VoidSpace, APipesVoidIsItsBoreLessTheBallsCaps) {
  const double inner = 0.4, length = 3, rolling = 0.8;
  VoidScene scene;
  Pose pose;
  pose.translation = {-1.5, 0.013, 3.007};  // off the ground, off the grid
  scene.add(testing::make_pipe(length, inner, 0.5), pose);
  VoidSpaceOptions options = options_with(0.02, rolling);
  options.ground = false;
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options);
  const double expected = kPi * inner * inner * length - 2 * cap_volume(rolling, inner);
  EXPECT_NEAR(space.volume(CellKind::free_void), expected, 0.02 * expected);
}

TEST(VoidSpace, AClosedRoomIsVoidAndItsWallsAreSolid) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {2, 1.52, 1}, 0.08);  // all on the grid
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options_with(0.04, 0.6));
  EXPECT_NEAR(space.volume(CellKind::free_void), 3.04, 1e-9);
  EXPECT_NEAR(space.volume(CellKind::solid), 2.16 * 1.68 * 1.08 - 3.04, 1e-9);
}

// Open at the front: what the ball reaches there is not void, but it is under the roof.
TEST(VoidSpace, UnderAnOpenRoofAllIsCoveredWhateverTheBallReaches) {
  VoidScene scene;
  scene.add(testing::make_box({0, 0, 1}, {2, 1.52, 1.08}));
  scene.add(testing::make_box({0, 0, 0}, {0.08, 1.52, 1}));
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options_with(0.04, 0.4));
  EXPECT_NEAR(space.covered_volume(), 1.92 * 1.52 * 1, 1e-9);
  EXPECT_LT(space.volume(CellKind::free_void), 0.7 * 1.92 * 1.52);
  EXPECT_NEAR(crop_to_pile(space, 0.1).covered_volume(), space.covered_volume(), 1e-9);
}

TEST(VoidSpace, NothingIsCoveredBesideABlockOnTheGround) {
  VoidScene scene;
  scene.add(testing::make_box({0, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(calc_void_space(scene.pile, scene.pointers(), options_with(0.05, 0.5)).covered_volume(), 0);
}

TEST(VoidSpace, AboutASingleBlockThereIsNoVoid) {
  VoidScene scene;
  scene.add(testing::make_box({0, 0, 0}, {1, 1, 1}));
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options_with(0.05, 0.5));
  EXPECT_EQ(space.volume(CellKind::free_void), 0);
}

TEST(VoidSpace, LostPiecesAreNotThere) {
  VoidScene scene;
  scene.add(testing::make_box({0, 0, 0}, {1, 1, 1}));
  scene.add(testing::make_box({2, 0, 0}, {3, 1, 1}));
  scene.pile.pieces[1].status = PieceStatus::lost;
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options_with(0.1, 0.5));
  EXPECT_NEAR(space.volume(CellKind::solid), 1, 1e-9);
}

TEST(VoidSpace, IsTheSameForAnyNumberOfThreads) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {1, 1, 1}, 0.1);
  VoidSpaceOptions options = options_with(0.05, 0.5);
  options.threads = 1;
  const VoidSpace one = calc_void_space(scene.pile, scene.pointers(), options);
  options.threads = 3;
  const VoidSpace three = calc_void_space(scene.pile, scene.pointers(), options);
  EXPECT_EQ(one.kind, three.kind);
  EXPECT_EQ(one.clearance, three.clearance);
}

TEST(VoidSpace, RefusesVoxelsThatMemoryCannotHold) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {4, 4, 2}, 0.1);
  VoidSpaceOptions options = options_with(0.002, 1);
  options.memory_limit = 1 << 28;
  try {
    calc_void_space(scene.pile, scene.pointers(), options);
    FAIL() << "expected an InputError";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("GiB are needed"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("use voxels of"), std::string::npos) << e.what();
  }
}

TEST(VoidSpace, NamesOptionsOutOfRange) {
  VoidScene scene;
  EXPECT_THROW(calc_void_space(scene.pile, {}, options_with(0, 1)), InputError);
  EXPECT_THROW(calc_void_space(scene.pile, {}, options_with(0.1, 0.1)), InputError);
}

}  // namespace void_space_test
}  // namespace rubble
