#include "kernel/voids/place_runs.h"

#include <algorithm>

namespace rubble {

// Runs beside each other are joined (union-find); then labels and ranks are given in the order of cells.
PlaceRuns::PlaceRuns(const VoidSpace& space, float radius) : row_(std::size_t(space.grid.size[0])) {
  const std::size_t depth = std::size_t(space.grid.size[1]), rows = depth * std::size_t(space.grid.size[2]);
  for (std::size_t row = 0; row < rows; ++row) {
    begin_.push_back(std::uint32_t(runs_.size()));
    for (std::size_t i = row * row_; i < (row + 1) * row_; ++i) {
      if (space.kind[i] != CellKind::free_void || space.clearance[i] < radius) continue;
      const std::uint32_t cell = std::uint32_t(i), number = std::uint32_t(runs_.size());
      if (number > begin_[row] && runs_.back().last + 1 == cell)
        runs_.back().last = cell;
      else
        runs_.push_back({cell, cell, number, 0});  // its own root
    }
  }
  begin_.push_back(std::uint32_t(runs_.size()));
  for (std::size_t row = 0; row < rows; ++row) {
    if (row % depth > 0) join_rows(row, row - 1);
    if (row >= depth) join_rows(row, row - depth);
  }
  std::vector<std::uint32_t> places;  // of each void so far
  for (std::uint32_t i = 0; i < runs_.size(); ++i) {
    Run& run = runs_[i];
    if (run.label == i) {
      run.label = voids_++;
      places.push_back(0);
    } else {
      run.label = runs_[run.label].label;  // of one before, which has its label
    }
    run.rank = places[run.label];
    places[run.label] += run.last - run.first + 1;
  }
}

// Lower roots win, so that no label is above the run's own number.
std::uint32_t PlaceRuns::find_root(std::uint32_t run) {
  while (runs_[run].label != run) run = runs_[run].label = runs_[runs_[run].label].label;
  return run;
}

void PlaceRuns::join_rows(std::size_t row, std::size_t other) {
  const std::uint32_t across = std::uint32_t((row - other) * row_);
  std::uint32_t a = begin_[row], b = begin_[other];
  while (a < begin_[row + 1] && b < begin_[other + 1]) {
    if (runs_[b].last + across < runs_[a].first) {
      ++b;
    } else if (runs_[a].last < runs_[b].first + across) {
      ++a;
    } else {
      const std::uint32_t p = find_root(a), q = find_root(b);
      runs_[std::max(p, q)].label = std::min(p, q);
      runs_[a].last < runs_[b].last + across ? ++a : ++b;
    }
  }
}

std::vector<CellRuns> PlaceRuns::list_voids() const {
  std::vector<std::vector<CellRun>> runs(voids_);
  for (const Run& run : runs_) runs[run.label].push_back({run.first, run.last - run.first + 1});
  std::vector<CellRuns> voids;
  for (std::vector<CellRun>& of_void : runs) voids.emplace_back(std::move(of_void));
  return voids;
}

}  // namespace rubble
