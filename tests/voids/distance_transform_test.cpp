// The feature transform against trying every seed.
#include "kernel/geometry/distance_transform.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kernel/base/random.h"

namespace rubble {
namespace distance_transform_test {

VoxelGrid make_grid(int x, int y, int z) {
  VoxelGrid grid;
  grid.size = {x, y, z};
  return grid;
}

long square_distance(const Cell& a, const Cell& b) {
  long sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += long(a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

std::vector<Cell> draw_seeds(const VoxelGrid& grid, std::size_t count, RandomStream& random) {
  std::vector<std::size_t> indices;
  while (indices.size() < count) indices.push_back(random.below(grid.count()));
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  std::vector<Cell> seeds;
  for (const std::size_t i : indices) seeds.push_back(grid.cell(i));
  return seeds;
}

TEST(DistanceTransform, FindsASeedThatIsAsNearAsTheNearest) {
  RandomStream random(3, "seeds");
  for (const std::size_t count : {1, 2, 7, 60, 900}) {
    const VoxelGrid grid = make_grid(23, 17, 19);
    const std::vector<Cell> seeds = draw_seeds(grid, count, random);
    ThreadPool pool(2);
    const auto nearest = find_nearest_seeds(grid, seeds, pool);
    for (std::size_t i = 0; i < grid.count(); ++i) {
      long best = 1L << 40;
      for (const Cell& seed : seeds) best = std::min(best, square_distance(seed, grid.cell(i)));
      ASSERT_EQ(square_distance(seeds[nearest[i]], grid.cell(i)), best)
          << "cell " << i << " with " << count << " seeds";
    }
  }
}

TEST(DistanceTransform, WithoutSeedsFindsNone) {
  ThreadPool pool(1);
  for (const std::uint32_t found : find_nearest_seeds(make_grid(4, 3, 2), {}, pool)) {
    EXPECT_EQ(found, kNoSeed);
  }
}

TEST(DistanceTransform, IsTheSameForAnyNumberOfThreads) {
  RandomStream random(4, "seeds");
  const VoxelGrid grid = make_grid(31, 33, 29);
  const std::vector<Cell> seeds = draw_seeds(grid, 500, random);
  ThreadPool one(1), three(3);
  EXPECT_EQ(find_nearest_seeds(grid, seeds, one), find_nearest_seeds(grid, seeds, three));
}

}  // namespace distance_transform_test
}  // namespace rubble
