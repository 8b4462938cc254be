#include "kernel/voids/rolling_ball.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/geometry/lower_envelope.h"

namespace rubble {
namespace {

constexpr int kNone = -1;

// Where the ball's centre may be.
class Roller {
 public:
  Roller(VoidSpace& space, bool ground) : space_(space), ground_(ground) {}

  // Where the ball's centre may be, reached from the border of the grid, is marked as outside; runs
  // of cells along X at a time, since most of the grid is such runs.
  void roll() {
    const Cell& n = space_.grid.size;
    std::vector<Cell> front;
    const auto drain = [&] {
      while (!front.empty()) {
        const Cell c = front.back();
        front.pop_back();
        fill_run(c, front);
      }
    };
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y) {
        const bool whole = y == 0 || y + 1 == n[1] || z + 1 == n[2] || (z == 0 && !ground_);
        for (int x = 0; x < n[0]; x += whole ? 1 : std::max(1, n[0] - 1)) {
          front.push_back({x, y, z});
          drain();
        }
      }
  }

 private:
  bool is_open(std::size_t i) const {
    return space_.kind[i] == CellKind::free_void &&
           space_.clearance[i] >= float(space_.rolling_radius);
  }

  // Marks the run of open cells along X that a cell is in; the runs beside it go to the front.
  void fill_run(const Cell& c, std::vector<Cell>& front) {
    const VoxelGrid& grid = space_.grid;
    const std::size_t row = grid.index({0, c[1], c[2]});
    if (!is_open(row + std::size_t(c[0]))) return;
    int first = c[0], last = c[0];
    while (first > 0 && is_open(row + std::size_t(first) - 1)) --first;
    while (last + 1 < grid.size[0] && is_open(row + std::size_t(last) + 1)) ++last;
    for (int x = first; x <= last; ++x) space_.kind.set(row + std::size_t(x), CellKind::outside);
    for (const auto& [dy, dz] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const Cell start{first, c[1] + dy, c[2] + dz};
      if (!grid.contains(start)) continue;
      const std::size_t beside = grid.index(start) - std::size_t(first);
      bool inside = false;
      for (int x = first; x <= last; ++x) {
        const bool open = is_open(beside + std::size_t(x));
        if (open && !inside) front.push_back({x, start[1], start[2]});
        inside = open;
      }
    }
  }

  VoidSpace& space_;
  const bool ground_;
};

// What the ball covers is found layer by layer from the bottom up. In a layer each cell has its
// nearest place of the ball's centre in this layer; the ball there covers a chord of the cell's
// column. So nothing is kept of the space but a few layers.
// space: after roll_ball().
class RollingBall {
 public:
  RollingBall(VoidSpace& space, ThreadPool& pool)
      : space_(space),
        pool_(pool),
        row_(std::size_t(space.grid.size[0])),
        layer_(row_ * std::size_t(space.grid.size[1])),
        // One voxel is added to the radius, because the centres of cells stand off the surface that
        // the ball touches by up to that.
        reach_(space.rolling_radius / space.grid.voxel + 1) {}

  void sweep() {
    const int batch = 2 * std::max(1, pool_.threads());
    std::vector<std::vector<int>> chords{std::size_t(batch), std::vector<int>(layer_)};
    covered_until_.assign(layer_, kNone);
    run_begin_.assign(layer_, 0);
    for (int first = 0; first < space_.grid.size[2]; first += batch) {
      const int count = std::min(batch, space_.grid.size[2] - first);
      pool_.run(count, 1, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) find_chords(first + k, chords[std::size_t(k)]);
      });
      pool_.run(space_.grid.size[1], 16, [&](int begin, int end) {
        for (int k = 0; k < count; ++k) cover(first + k, chords[std::size_t(k)], begin, end);
      });
    }
  }

 private:
  // chords: for each cell of the layer how far above and below it the ball around its nearest place
  // in this layer covers its column; kNone: there is no place within reach. Unit: cells. The marks
  // of this layer are those of roll() still.
  void find_chords(int z, std::vector<int>& chords) const {
    const std::size_t begin = std::size_t(z) * layer_;
    const int most = int(std::ceil(reach_));
    for (std::size_t y = 0; y < layer_; y += row_) find_beside(begin + y, most, &chords[y]);
    LowerEnvelope envelope(space_.grid.size[1]);
    std::vector<int> beside(std::size_t(space_.grid.size[1]));
    for (std::size_t x = 0; x < row_; ++x) {
      envelope.clear();
      for (std::size_t y = 0; y < beside.size(); ++y) {
        beside[y] = chords[x + y * row_];
        if (beside[y] != kNone) envelope.add(int(y), std::int64_t(beside[y]) * beside[y]);
      }
      if (envelope.empty()) continue;
      envelope.for_each(int(beside.size()), [&](int y, int vertex) {
        const double dx = beside[std::size_t(vertex)], dy = y - vertex;
        chords[x + std::size_t(y) * row_] = find_chord(dx * dx + dy * dy);
      });
    }
  }

  // Of each cell of a row, the distance to the nearest place in it; kNone: farther than `most`.
  // Unit: cells.
  void find_beside(std::size_t begin, int most, int* distance) const {
    const int n = int(row_);
    for (int x = 0, last = -most - 1; x < n; ++x) {
      if (space_.kind[begin + std::size_t(x)] == CellKind::outside) last = x;
      distance[x] = x - last <= most ? x - last : kNone;
    }
    for (int x = n - 1, last = n + most; x >= 0; --x) {
      if (space_.kind[begin + std::size_t(x)] == CellKind::outside) last = x;
      if (last - x <= most && (distance[x] == kNone || last - x < distance[x]))
        distance[x] = last - x;
    }
  }

  // The largest whole number whose square, with that of the distance, is below the square of the
  // reach.
  int find_chord(double square) const {
    const double left = reach_ * reach_ - square;
    if (left <= 0) return kNone;
    int chord = int(std::sqrt(left));
    while (chord >= 0 && square + double(chord) * chord >= reach_ * reach_) --chord;
    while (square + double(chord + 1) * (chord + 1) < reach_ * reach_) ++chord;
    return chord;
  }

  // Marks what the chords of a layer cover there and below, and notes how far up they reach. Rows
  // [begin, end).
  void cover(int z, const std::vector<int>& chords, int begin, int end) {
    for (std::size_t c = std::size_t(begin) * row_; c < std::size_t(end) * row_; ++c) {
      if (chords[c] != kNone) covered_until_[c] = std::max(covered_until_[c], z + chords[c]);
      if (covered_until_[c] < z) {
        run_begin_[c] = z + 1;
        continue;
      }
      mark(c, z);
      const int lowest = chords[c] == kNone ? z : std::max(0, z - chords[c]);
      while (run_begin_[c] > lowest) mark(c, --run_begin_[c]);
    }
  }

  void mark(std::size_t column, int z) {
    const std::size_t cell = column + std::size_t(z) * layer_;
    if (space_.kind[cell] != CellKind::solid) space_.kind.set(cell, CellKind::outside);
  }

  VoidSpace& space_;
  ThreadPool& pool_;
  const std::size_t row_, layer_;  // cells
  const double reach_;             // of the ball; unit: cells
  // Of each column: the highest layer that is known to be covered, and the lowest of the run of
  // covered ones that the current layer continues.
  std::vector<int> covered_until_, run_begin_;
};

}  // namespace

void roll_ball(VoidSpace& space, bool ground) { Roller(space, ground).roll(); }

void sweep_outside(VoidSpace& space, bool ground, ThreadPool& pool) {
  roll_ball(space, ground);
  RollingBall(space, pool).sweep();
}

}  // namespace rubble
