// Cells along rays, against all cells of the grid tried one by one.
#include "kernel/voids/seen_cells.h"

#include <gtest/gtest.h>

#include <numeric>

#include "kernel/base/random.h"
#include "kernel/voids/void_map.h"
#include "kernel/voids/void_path.h"
#include "void_scenes.h"

namespace rubble {
namespace seen_cells_test {

VoxelGrid small_grid() {
  VoxelGrid grid;
  grid.corner = {-1, 0.5, 2};
  grid.voxel = 0.25;
  grid.size = {9, 7, 5};
  return grid;
}

std::vector<std::uint32_t> all_cells(const VoxelGrid& grid) {
  std::vector<std::uint32_t> cells(grid.count());
  std::iota(cells.begin(), cells.end(), 0u);
  return cells;
}

// How long a ray is within a cell; unit: m.
double length_within(const VoxelGrid& grid, std::uint32_t index, const Vec3& from, const Vec3& d, double range) {
  const Vec3 low = grid.centre(index) - Vec3{0.5, 0.5, 0.5} * grid.voxel;
  double first = 0, last = range;
  for (int k = 0; k < 3; ++k) {
    const double a = (low[k] - from[k]) / d[k], b = (low[k] + grid.voxel - from[k]) / d[k];
    first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
  }
  return last - first;
}

TEST(SeenCells, AreThoseThatTheRayPasses) {
  const VoxelGrid grid = small_grid();
  SeenCells seen(grid, all_cells(grid));
  RandomStream random(5, "rays");
  std::size_t passed = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 from{random.uniform(-2, 2), random.uniform(0, 3), random.uniform(1.5, 3.5)};
    const Vec3 d = random.direction();
    const double range = random.uniform(0, 3);
    seen.forget();
    seen.mark(from, d, range);
    for (std::uint32_t c = 0; c < grid.count(); ++c) {
      const double length = length_within(grid, c, from, d, range);
      if (std::fabs(length) < 1e-9) continue;  // it touches a corner, which counts or not
      EXPECT_EQ(seen.is_seen(c), length > 0) << "ray " << i << ", cell " << c << ", for " << length << " m";
      passed += length > 0;
    }
  }
  EXPECT_GT(passed, 500u);
}

TEST(SeenCells, CountOnceAndOnlyWhereTheyAreWanted) {
  const VoxelGrid grid = small_grid();
  SeenCells seen(grid, {std::uint32_t(grid.index({0, 3, 2})), std::uint32_t(grid.index({8, 3, 2})),
                        std::uint32_t(grid.index({4, 0, 0}))});
  const Vec3 from = grid.centre(Cell{0, 3, 2});
  seen.mark(from, {1, 0, 0}, 1);
  EXPECT_EQ(seen.count(), 1u);
  seen.mark(from, {1, 0, 0}, 10);
  seen.mark(from, {1, 0, 0}, 10);
  EXPECT_EQ(seen.count(), 2u);
  EXPECT_DOUBLE_EQ(seen.share(), 2.0 / 3);
  seen.mark(from, {0, 0, 1}, 0);  // stays in its cell
  EXPECT_EQ(seen.count(), 2u);
  seen.forget();
  EXPECT_EQ(seen.count(), 0u);
  EXPECT_FALSE(seen.is_seen(std::uint32_t(grid.index({0, 3, 2}))));
}

// A tunnel 6 m long and 1 m wide along X, closed at one end.
testing::VoidScene tunnel() {
  testing::VoidScene scene;
  scene.add(testing::make_box({0, -0.8, 0}, {6, -0.5, 1.3}));
  scene.add(testing::make_box({0, 0.5, 0}, {6, 0.8, 1.3}));
  scene.add(testing::make_box({0, -0.8, 1}, {6, 0.8, 1.3}));
  scene.add(testing::make_box({6, -0.8, 0}, {6.3, 0.8, 1.3}));
  return scene;
}

TEST(WaysIn, GrowAlongATunnel) {
  const testing::VoidScene scene = tunnel();
  VoidSpaceOptions options;
  options.voxel = 0.1;
  const VoidMap map = find_voids(calc_void_space(scene.pile, scene.pointers(), options), {0.2});
  ASSERT_EQ(map.robots.front().voids.size(), 1u);
  const Void& v = map.robots.front().voids.front();
  const std::vector<double> ways = calc_ways_in(map.space, v);
  ASSERT_EQ(ways.size(), v.places.size());
  double nearest = 1e9, farthest = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Vec3 place = map.space.grid.centre(v.places[i]);
    // Along the tunnel, and up to its width across it.
    EXPECT_NEAR(ways[i], place.x - v.entrances.front().position.x, 0.5) << place.x;
    nearest = std::min(nearest, ways[i]), farthest = std::max(farthest, ways[i]);
  }
  EXPECT_EQ(nearest, 0);
  EXPECT_NEAR(farthest, v.path_length, 1e-12);
}

TEST(WaysThrough, AreTheLengthsOfTheShortestOnes) {
  const testing::VoidScene scene = tunnel();
  VoidSpaceOptions options;
  options.voxel = 0.1;
  const VoidSpace space = calc_void_space(scene.pile, scene.pointers(), options);
  const Vec3 start{-1, 0, 0.5};
  const std::vector<float> ways = calc_ways_through(space, start, 0.2);
  const auto way_to = [&](const Vec3& p) { return ways[space.grid.index(space.grid.find_cell(p))]; };
  EXPECT_EQ(way_to(start), 0);
  EXPECT_NEAR(way_to({5, 0, 0.5}), 6, 0.15);
  EXPECT_FALSE(std::isfinite(way_to({5, 0.45, 0.5}))) << "nearer to the wall than the radius";
  EXPECT_GT(way_to({7, 0, 0.5}), 7.9f) << "through the closed end";
  EXPECT_LT(way_to({7, 0, 0.5}), 9.5f);
}

}  // namespace seen_cells_test
}  // namespace rubble
