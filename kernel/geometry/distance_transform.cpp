#include "kernel/geometry/distance_transform.h"

#include "kernel/geometry/lower_envelope.h"

namespace rubble {
namespace {

std::int64_t square(int a) { return std::int64_t(a) * a; }

void put_seed(void* nearest, std::size_t cell, std::uint32_t seed) {
  std::memcpy(static_cast<char*>(nearest) + 4 * cell, &seed, 4);
}

// One line of cells along an axis: takes every cell's seed so far, gives the nearest along it.
struct Sweep {
  const VoxelGrid& grid;
  const std::vector<Cell>& seeds;
  void* nearest;
  int axis;

  void run(const Cell& first, LowerEnvelope& envelope, std::vector<std::uint32_t>& line) const {
    const int length = grid.size[std::size_t(axis)];
    std::size_t stride = 1;
    for (int i = 0; i < axis; ++i) stride *= std::size_t(grid.size[std::size_t(i)]);
    const std::size_t begin = grid.index(first);
    envelope.clear();
    for (int i = 0; i < length; ++i) {
      const std::uint32_t seed = seed_at(nearest, begin + std::size_t(i) * stride);
      line[std::size_t(i)] = seed;
      if (seed == kNoSeed) continue;
      std::int64_t height = 0;
      for (int k = 0; k < axis; ++k) {
        height += square(seeds[seed][std::size_t(k)] - first[std::size_t(k)]);
      }
      envelope.add(i, height);
    }
    if (envelope.empty()) return;
    envelope.for_each(length, [&](int i, int vertex) {
      put_seed(nearest, begin + std::size_t(i) * stride, line[std::size_t(vertex)]);
    });
  }
};

}  // namespace

std::vector<std::uint32_t> find_nearest_seeds(const VoxelGrid& grid, const std::vector<Cell>& seeds,
                                              ThreadPool& pool) {
  std::vector<std::uint32_t> nearest(grid.count());
  find_nearest_seeds(grid, seeds, pool, nearest.data());
  return nearest;
}

void find_nearest_seeds(const VoxelGrid& grid, const std::vector<Cell>& seeds, ThreadPool& pool,
                        void* nearest) {
  std::memset(nearest, 0xff, 4 * grid.count());  // kNoSeed
  for (std::size_t i = 0; i < seeds.size(); ++i)
    put_seed(nearest, grid.index(seeds[i]), std::uint32_t(i));
  for (int axis = 0; axis < 3; ++axis) {
    const Sweep sweep{grid, seeds, nearest, axis};
    // Lines beside each other along x share cache lines, so x is the inner loop where it can be.
    const int inner = axis == 0 ? 1 : 0, outer = axis == 2 ? 1 : 2;
    pool.run(grid.size[std::size_t(outer)], 1, [&](int begin, int end) {
      LowerEnvelope envelope(grid.size[std::size_t(axis)]);
      std::vector<std::uint32_t> line(std::size_t(grid.size[std::size_t(axis)]));
      for (int o = begin; o < end; ++o) {
        for (int i = 0; i < grid.size[std::size_t(inner)]; ++i) {
          Cell first{0, 0, 0};
          first[std::size_t(inner)] = i;
          first[std::size_t(outer)] = o;
          sweep.run(first, envelope, line);
        }
      }
    });
  }
}

}  // namespace rubble
