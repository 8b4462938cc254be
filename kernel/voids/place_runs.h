// The places of a robot's centre, and the voids that they form. Internal to kernel/voids.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/voids/cell_runs.h"
#include "kernel/voids/void_space.h"

namespace rubble {

class PlaceRuns {
 public:
  struct Run {
    std::uint32_t first, last;  // cells of one row; inclusive
    std::uint32_t label;        // number of its void
    std::uint32_t rank;         // how many places of its void come before
  };

  // A place is a void cell whose clearance is at least `radius`.
  PlaceRuns(const VoidSpace& space, float radius);

  // The run that a cell is in; null: it is no place.
  const Run* find(std::size_t cell) const {
    const std::size_t row = cell / row_;
    std::uint32_t at = begin_[row];
    const std::uint32_t end = begin_[row + 1];
    while (at < end && runs_[at].last < cell) ++at;
    return at < end && runs_[at].first <= cell ? &runs_[at] : nullptr;
  }
  // Of each void its places. Voids are connected by faces of cells, and numbered by their lowest cell.
  std::vector<CellRuns> list_voids() const;

 private:
  void join_rows(std::size_t row, std::size_t other);
  std::uint32_t find_root(std::uint32_t run);

  std::size_t row_;                   // cells
  std::vector<Run> runs_;             // ascending
  std::vector<std::uint32_t> begin_;  // of each row, its first run; one more at the end
  std::uint32_t voids_ = 0;
};

}  // namespace rubble
