#include "kernel/voids/ball_cover.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace rubble {
namespace {

constexpr int kBatch = 64;  // of the map at a time
constexpr double kNowhere = std::numeric_limits<double>::infinity();

// The lowest of some parabolas (x - p)^2 + height, wherever their vertices p are (Felzenszwalb and Huttenlocher 2012,
// "Distance transforms of sampled functions").
class RealEnvelope {
 public:
  void clear() { lowest_.clear(); }
  bool empty() const { return lowest_.empty(); }

  // Vertices come in ascending order.
  void add(double p, double height) {
    double start = -kNowhere;
    while (!lowest_.empty()) {
      const Parabola& last = lowest_.back();
      start = ((p * p + height) - (last.p * last.p + last.height)) / (2 * (p - last.p));
      if (start > last.start) break;
      lowest_.pop_back();
      start = -kNowhere;
    }
    lowest_.push_back({p, height, start});
  }

  // Calls visit(i, value at first + i * step) for i from 0 to count - 1.
  template <typename Visit>
  void for_each(double first, double step, int count, Visit&& visit) const {
    std::size_t at = 0;
    for (int i = 0; i < count; ++i) {
      const double x = first + i * step;
      while (at + 1 < lowest_.size() && lowest_[at + 1].start <= x) ++at;
      const double off = x - lowest_[at].p;
      visit(i, off * off + lowest_[at].height);
    }
  }

 private:
  struct Parabola {
    double p, height, start;  // lowest from `start` on
  };
  std::vector<Parabola> lowest_;
};

// A point is in a ball where its squared distance from the centre, less the squared radius, is below zero. The least of
// that over all balls is found axis by axis: along Z for some layers of the map, then in each layer along X and Y.
class Cover {
 public:
  Cover(const VoidSpace& balls, VoidSpace& map, ThreadPool& pool)
      : balls_(balls), map_(map), pool_(pool), columns_(std::size_t(balls.grid.size[0]) * std::size_t(balls.grid.size[1])) {}

  void run() {
    const int layers = map_.grid.size[2];
    for (int first = 0; first < layers; first += kBatch) {
      const int count = std::min(kBatch, layers - first);
      along_z(first, count);
      pool_.run(count, 1, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) mark_layer(first + k, &heights_[std::size_t(k) * columns_]);
      });
    }
  }

 private:
  // Of the centre of a cell, along an axis; unit: m.
  static double place(const VoxelGrid& grid, int axis, int i) { return grid.corner[axis] + (i + 0.5) * grid.voxel; }

  void along_z(int first, int count) {
    heights_.assign(std::size_t(count) * columns_, kNowhere);
    pool_.run(balls_.grid.size[1], 4, [&](int begin, int end) {
      RealEnvelope envelope;
      for (std::size_t c = std::size_t(begin) * std::size_t(balls_.grid.size[0]); c < std::size_t(end) * std::size_t(balls_.grid.size[0]); ++c) {
        envelope.clear();
        for (int z = 0; z < balls_.grid.size[2]; ++z) {
          const std::size_t i = std::size_t(z) * columns_ + c;
          if (balls_.kind[i] != CellKind::outside) continue;
          const double radius = double(balls_.clearance[i]) + map_.grid.voxel;
          envelope.add(place(balls_.grid, 2, z), -radius * radius);
        }
        if (envelope.empty()) continue;
        envelope.for_each(place(map_.grid, 2, first), map_.grid.voxel, count,
                          [&](int k, double value) { heights_[std::size_t(k) * columns_ + c] = value; });
      }
    });
  }

  void mark_layer(int z, const double* heights) {
    const VoxelGrid &from = balls_.grid, &to = map_.grid;
    const std::size_t rows = std::size_t(from.size[1]), row = std::size_t(to.size[0]);
    std::vector<double> along_x(row * rows, kNowhere);  // of each X of the map all rows of the balls
    RealEnvelope envelope;
    for (std::size_t y = 0; y < rows; ++y) {
      envelope.clear();
      for (int x = 0; x < from.size[0]; ++x) {
        const double height = heights[y * std::size_t(from.size[0]) + std::size_t(x)];
        if (height < kNowhere) envelope.add(place(from, 0, x), height);
      }
      if (envelope.empty()) continue;
      envelope.for_each(place(to, 0, 0), to.voxel, to.size[0],
                        [&](int x, double value) { along_x[std::size_t(x) * rows + y] = value; });
    }
    for (std::size_t x = 0; x < row; ++x) {
      envelope.clear();
      for (std::size_t y = 0; y < rows; ++y)
        if (along_x[x * rows + y] < kNowhere) envelope.add(place(from, 1, int(y)), along_x[x * rows + y]);
      if (envelope.empty()) continue;
      const std::size_t first = to.index({int(x), 0, z});
      envelope.for_each(place(to, 1, 0), to.voxel, to.size[1], [&](int y, double value) {
        if (value < 0) map_.kind.set(first + std::size_t(y) * row, CellKind::outside);
      });
    }
  }

  const VoidSpace& balls_;
  VoidSpace& map_;
  ThreadPool& pool_;
  const std::size_t columns_;    // of the balls
  std::vector<double> heights_;  // of some layers of the map, along the columns of the balls
};

}  // namespace

void cover_by_balls(const VoidSpace& balls, VoidSpace& map, ThreadPool& pool) { Cover(balls, map, pool).run(); }

}  // namespace rubble
