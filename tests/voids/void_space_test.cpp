// Voxels against closed forms and against exact queries.
#include "kernel/voids/void_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/clearance_survey.h"
#include "kernel/voids/void_map.h"
#include "tests/base/peak_memory.h"
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
  for (std::size_t i = 0; i < one.kind.size(); ++i) ASSERT_EQ(one.clearance[i], three.clearance[i]) << "cell " << i;
}

// Where the centre of the rolling ball comes to from the border of the grid, by single steps.
std::vector<Cell> find_places_of_ball(const VoidSpace& space) {
  const auto is_open = [&](std::size_t i) {
    return space.kind[i] != CellKind::solid && space.clearance[i] >= float(space.rolling_radius);
  };
  std::vector<char> reached(space.grid.count(), 0);
  std::vector<std::size_t> front;
  const auto reach = [&](std::size_t i) {
    if (reached[i] || !is_open(i)) return;
    reached[i] = 1;
    front.push_back(i);
  };
  for (std::size_t i = 0; i < reached.size(); ++i) {
    int neighbours = 0;
    for_each_neighbour(space.grid, i, [&](std::size_t) { ++neighbours; });
    if (neighbours < 6) reach(i);
  }
  std::vector<Cell> places;
  while (!front.empty()) {
    const std::size_t i = front.back();
    front.pop_back();
    places.push_back(space.grid.cell(i));
    for_each_neighbour(space.grid, i, reach);
  }
  return places;
}

TEST(VoidSpace, OutsideIsWhatTheBallCoversInOneOfItsPlaces) {
  RandomStream random(5, "void space");
  VoidScene scene;
  for (int i = 0; i < 14; ++i) {
    const Vec3 position{random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8)};
    scene.add(testing::make_box({-0.5, -0.4, -0.05}, {0.5, 0.4, 0.05}), turned(random, position));
  }
  VoidSpaceOptions options = options_with(0.08, 0.3);
  options.ground = false;
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options);
  const std::vector<Cell> places = find_places_of_ball(space);
  const double reach = options.rolling_radius / options.voxel + 1;
  std::size_t outside = 0, inside = 0;
  for (std::size_t i = 0; i < space.grid.count(); i += 3) {
    if (space.kind[i] == CellKind::solid) continue;
    const Cell c = space.grid.cell(i);
    const bool covered = std::any_of(places.begin(), places.end(), [&](const Cell& p) {
      double square = 0;
      for (std::size_t k = 0; k < 3; ++k) square += double(p[k] - c[k]) * (p[k] - c[k]);
      return square < reach * reach;
    });
    ASSERT_EQ(space.kind[i] == CellKind::outside, covered) << "cell " << i;
    ++(covered ? outside : inside);
  }
  EXPECT_GT(outside, 1000u);
  EXPECT_GT(inside, 100u);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they take memory of their own
// A kind and a clearance a cell, and little besides, from the beginning to the end.
TEST(VoidSpace, AVoidMapTakesAFewBytesACell) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {0.8, 0.8, 0.8}, 0.1);
  scene.add(testing::make_box({4, 4, 0}, {4.3, 4.3, 2}));
  testing::forget_peak_memory();
  const long before = testing::peak_memory();
  ASSERT_GT(before, 0);
  VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options_with(0.02, 0.5));
  const double cells = double(space.grid.count());
  const VoidMap map = find_voids(crop_to_pile(std::move(space), 0.1), {0.1});
  ASSERT_EQ(map.robots[0].voids.size(), 1u);
  EXPECT_LT(double(testing::peak_memory() - before) * 1024 / cells, 8.5);  // 7.1; 11.6 with lists of all cells
}
#endif

// Between two boxes of the same height, a ball dips into the gap by r - sqrt(r2 - w2 / 4). Voxels are a hundredth of its
// radius, so that it rolls over larger ones.
TEST(VoidSpace, ALargeBallDipsIntoAGapAsFarAsItsRadiusSays) {
  const double width = 1.2, radius = 2, top = 1.003;
  VoidScene scene;
  scene.add(testing::make_box({-1.6, -2, 0}, {-width / 2, 2, top}));
  scene.add(testing::make_box({width / 2, -2, 0}, {1.6, 2, top}));
  VoidSpaceOptions options = options_with(0.02, radius);
  options.margin = 0.1;
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options);
  EXPECT_LT(space.grid.size[0] * space.grid.voxel, 3.6) << "no room for the ball is kept";
  for (const double x : {0.0, 0.2, -0.4}) {
    const double lowest = top - std::sqrt(radius * radius - x * x) + std::sqrt(radius * radius - width * width / 4);
    double highest = 0;
    for (int z = 0; z < space.grid.size[2]; ++z) {
      const Cell c = space.grid.find_cell({x, 0, space.grid.corner.z + (z + 0.5) * space.grid.voxel});
      if (space.kind[space.grid.index(c)] == CellKind::free_void) highest = space.grid.centre(c).z;
    }
    EXPECT_NEAR(highest, lowest - 0.5 * options.voxel, 1.5 * options.voxel) << "a voxel is added to the ball; at x " << x;
  }
}

TEST(VoidSpace, IsTheSameWithLittleOfTheOutside) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {1.2, 1, 0.8}, 0.1);
  scene.add(testing::make_box({1.5, 0.1, 0}, {2, 0.9, 1.1}));
  VoidSpaceOptions options = options_with(0.02, 1.3);
  const VoidSpace whole = calc_void_space(scene.pile, scene.pointers(), options);
  options.margin = 0.1;
  const VoidSpace part = calc_void_space(scene.pile, scene.pointers(), options);
  EXPECT_LT(part.grid.count(), whole.grid.count() / 3);
  std::size_t other = 0;
  for (std::size_t i = 0; i < part.kind.size(); ++i) {
    const std::size_t k = whole.grid.index(whole.grid.find_cell(part.grid.centre(i)));
    const bool is_void = whole.kind[k] == CellKind::free_void;
    other += part.kind[i] != whole.kind[k] || (is_void && std::abs(part.clearance[i] - whole.clearance[k]) > 1e-5f);
  }
  EXPECT_LT(other, part.kind.size() / 1000) << "corners of cells are rounded in other places";
  EXPECT_NEAR(part.volume(CellKind::free_void), whole.volume(CellKind::free_void), 0.001);
}

// Tile by tile as in one piece, to the bit: also of cells whose nearest surface is far beyond the tile.
TEST(VoidSpace, ClearanceOfSomeCellsIsThatOfAll) {
  RandomStream random(5, "tiles");
  VoidScene scene;
  for (int i = 0; i < 60; ++i)
    scene.add(testing::make_box({-0.05, -0.1, -0.02}, {0.05, 0.1, 0.02}),
              turned(random, {random.uniform(0, 3), random.uniform(0, 5), random.uniform(0, 0.4)}));
  const Solids solids = place_solids(scene.pile, scene.pointers());
  ThreadPool pool(2);
  VoidSpace all;
  all.grid.voxel = 0.02, all.grid.corner = {-0.5, -0.5, -0.1}, all.grid.size = {350, 300, 30};
  all.kind = CellKinds(all.grid.count());
  fill_solids(all.grid, solids, pool, all.kind);
  VoidSpace some = all;
  std::vector<bool> wanted(all.grid.count());
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = random.below(3) == 0;
  all.clearance = CellClearance(all.grid.count());
  some.clearance.keep(wanted);
  for (VoidSpace* space : {&all, &some}) measure_clearance(*space, solids, pool, [](double) {});
  for (std::size_t i = 0; i < wanted.size(); ++i)
    ASSERT_EQ(some.clearance[i], wanted[i] ? all.clearance[i] : 0) << "cell " << i;
}

// With terrain, the nearest surface may be where the map is not.
TEST(VoidSpace, KnowsTerrainBesideIt) {
  VoidScene scene;
  scene.add(testing::make_box({-0.5, -0.5, 0}, {0.5, 0.5, 1}));
  scene.add(testing::make_box({1.3, -5, 0}, {1.5, 5, 3}));
  VoidSpaceOptions options = options_with(0.02, 2);
  options.margin = 0.6, options.scenery = {1};
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options);
  const Vec3 p{1.05, 0, 0.7};
  const Cell c = space.grid.find_cell(p);
  ASSERT_TRUE(space.grid.contains(c));
  EXPECT_NEAR(space.clearance[space.grid.index(c)], 1.3 - space.grid.centre(c).x, 1e-3);
}

TEST(VoidSpace, RefusesMoreCellsThan32BitsNumber) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {20, 20, 10}, 0.1);
  VoidSpaceOptions options = options_with(0.005, 1);
  options.memory_limit = 1e13;
  try {
    calc_void_space(scene.pile, scene.pointers(), options);
    FAIL() << "expected an InputError";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("cells"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("use voxels of"), std::string::npos) << e.what();
  }
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

TEST(VoidSpace, TakesTheVoxelThatFitsWhereItMay) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {4, 4, 2}, 0.1);
  VoidSpaceOptions options = options_with(0.004, 1);
  options.memory_limit = 1 << 28;
  for (const double coarsest : {0.004, 0.005}) {
    options.coarsest = coarsest;
    EXPECT_THROW(calc_void_space(scene.pile, scene.pointers(), options), InputError) << coarsest;
  }
  options.coarsest = 0.05;
  const double fitting = calc_void_space(scene.pile, scene.pointers(), options).grid.voxel;
  EXPECT_GT(fitting, 0.005);
  EXPECT_LT(fitting, 0.03);
  options.voxel = 0.1;
  EXPECT_EQ(calc_void_space(scene.pile, scene.pointers(), options).grid.voxel, 0.1);
}

TEST(VoidSpace, NamesOptionsOutOfRange) {
  VoidScene scene;
  EXPECT_THROW(calc_void_space(scene.pile, {}, options_with(0, 1)), InputError);
  EXPECT_THROW(calc_void_space(scene.pile, {}, options_with(0.1, 0.1)), InputError);
  VoidSpaceOptions options = options_with(0.1, 1);
  options.margin = -1;
  EXPECT_THROW(calc_void_space(scene.pile, {}, options), InputError);
}

}  // namespace void_space_test
}  // namespace rubble
