#include "kernel/voids/seen_cells.h"

#include "kernel/voids/cell_walk.h"

namespace rubble {

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
  walk_cells(grid_, from, direction, range, [this](std::size_t cell) {
    State& state = state_[cell];
    if (state == State::hidden) state = State::seen, ++count_;
    return true;
  });
}

}  // namespace rubble
