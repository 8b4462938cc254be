// For every cell the nearest of some seed cells: the exact Euclidean feature transform.
//
// One sweep an axis; along each line the lower envelope of parabolas (Felzenszwalb and Huttenlocher
// 2012, "Distance transforms of sampled functions"; in whole numbers as Meijster, Roerdink and
// Hesselink 2000). Of seeds that are equally near, which one is found does not depend on threads.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/geometry/voxel_grid.h"

namespace rubble {

inline constexpr std::uint32_t kNoSeed = 0xffffffffu;

// seeds: cells of the grid. Result: for every cell the number of its nearest seed, or kNoSeed where
// there are no seeds at all.
std::vector<std::uint32_t> find_nearest_seeds(const VoxelGrid& grid, const std::vector<Cell>& seeds,
                                              ThreadPool& pool);

// The same, into four bytes a cell of the caller's, who then needs their room for something else.
void find_nearest_seeds(const VoxelGrid& grid, const std::vector<Cell>& seeds, ThreadPool& pool,
                        void* nearest);
inline std::uint32_t seed_at(const void* nearest, std::size_t cell) {
  std::uint32_t seed = 0;
  std::memcpy(&seed, static_cast<const char*>(nearest) + 4 * cell, 4);
  return seed;
}

}  // namespace rubble
