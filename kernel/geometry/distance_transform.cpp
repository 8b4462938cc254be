#include "kernel/geometry/distance_transform.h"

namespace rubble {
namespace {

// The parabolas that are lowest somewhere along one line.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(int length) : vertex_(std::size_t(length)), start_(std::size_t(length)) {}

  void clear() { count_ = 0; }

  // height: squared distance of the seed from the line. Vertices come in ascending order.
  void add(int vertex, std::int64_t height) {
    std::int64_t start = 0;
    while (count_ > 0) {
      start = find_start(vertex_[count_ - 1], vertex, height);
      if (start > start_[count_ - 1]) break;
      --count_;
      start = 0;
    }
    vertex_[count_] = {vertex, height};
    start_[count_++] = start;
  }

  // Calls visit(position, vertex) for positions 0 to length - 1.
  template <typename Visit>
  void for_each(int length, Visit&& visit) const {
    std::size_t at = 0;
    for (int i = 0; i < length; ++i) {
      while (at + 1 < count_ && start_[at + 1] <= i) ++at;
      visit(i, vertex_[at].position);
    }
  }
  bool empty() const { return count_ == 0; }

 private:
  struct Parabola {
    int position;
    std::int64_t height;
  };

  // The first whole position where the later parabola is lower than the earlier one.
  static std::int64_t find_start(const Parabola& a, int vertex, std::int64_t height) {
    const std::int64_t p = a.position, q = vertex;
    const std::int64_t above = (q * q + height) - (p * p + a.height);
    const std::int64_t width = 2 * (q - p);
    const std::int64_t floor = above >= 0 ? above / width : -((-above + width - 1) / width);
    return floor < 0 ? 0 : floor + 1;
  }

  std::vector<Parabola> vertex_;
  std::vector<std::int64_t> start_;
  std::size_t count_ = 0;
};

std::int64_t square(int a) { return std::int64_t(a) * a; }

// One line of cells along an axis: takes every cell's seed so far, gives the nearest along it.
struct Sweep {
  const VoxelGrid& grid;
  const std::vector<Cell>& seeds;
  std::vector<std::uint32_t>& nearest;
  int axis;

  void run(const Cell& first, LowerEnvelope& envelope, std::vector<std::uint32_t>& line) const {
    const int length = grid.size[std::size_t(axis)];
    std::size_t stride = 1;
    for (int i = 0; i < axis; ++i) stride *= std::size_t(grid.size[std::size_t(i)]);
    const std::size_t begin = grid.index(first);
    envelope.clear();
    for (int i = 0; i < length; ++i) {
      const std::uint32_t seed = nearest[begin + std::size_t(i) * stride];
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
      nearest[begin + std::size_t(i) * stride] = line[std::size_t(vertex)];
    });
  }
};

}  // namespace

std::vector<std::uint32_t> find_nearest_seeds(const VoxelGrid& grid, const std::vector<Cell>& seeds,
                                              ThreadPool& pool) {
  std::vector<std::uint32_t> nearest(grid.count(), kNoSeed);
  for (std::size_t i = 0; i < seeds.size(); ++i) nearest[grid.index(seeds[i])] = std::uint32_t(i);
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
  return nearest;
}

}  // namespace rubble
