#include "kernel/voids/seen_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rubble {
namespace {

constexpr double kNoBorder = std::numeric_limits<double>::infinity();

// The part of a ray within the grid, as distances from its origin; empty when last < first.
struct Span {
  double first = 0, last = 0;
};

Span clip(const VoxelGrid& grid, const Vec3& from, const Vec3& direction, double range) {
  Span span{0, range};
  for (int k = 0; k < 3; ++k) {
    const double low = grid.corner[k] - from[k], high = low + grid.size[std::size_t(k)] * grid.voxel;
    if (direction[k] == 0) {
      if (low > 0 || high <= 0) return {0, -1};
      continue;
    }
    const double a = low / direction[k], b = high / direction[k];
    span.first = std::max(span.first, std::min(a, b));
    span.last = std::min(span.last, std::max(a, b));
  }
  return span;
}

}  // namespace

SeenCells::SeenCells(const VoxelGrid& grid, const std::vector<std::uint32_t>& wanted)
    : grid_(grid), state_(grid.count(), State::ignored), wanted_(wanted.size()) {
  for (const std::uint32_t cell : wanted) state_[cell] = State::hidden;
}

void SeenCells::forget() {
  for (State& state : state_)
    if (state == State::seen) state = State::hidden;
  count_ = 0;
}

void SeenCells::mark(const Vec3& from, const Vec3& direction, double range) {
  const Span span = clip(grid_, from, direction, range);
  if (span.last < span.first) return;
  Cell cell = grid_.find_cell(from + direction * span.first);
  double next[3], between[3];  // distance to the next border along each axis, and from one to the next
  int step[3];
  for (std::size_t k = 0; k < 3; ++k) {
    cell[k] = std::clamp(cell[k], 0, grid_.size[k] - 1);
    const double d = direction[int(k)];
    step[k] = d > 0 ? 1 : -1;
    const double border = grid_.corner[int(k)] + (cell[k] + (d > 0 ? 1 : 0)) * grid_.voxel;
    next[k] = d != 0 ? (border - from[int(k)]) / d : kNoBorder;
    between[k] = d != 0 ? grid_.voxel / std::fabs(d) : kNoBorder;
  }
  while (grid_.contains(cell)) {
    State& state = state_[grid_.index(cell)];
    if (state == State::hidden) state = State::seen, ++count_;
    const std::size_t k = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (next[k] > span.last) return;
    cell[k] += step[k];
    next[k] += between[k];
  }
}

}  // namespace rubble
