// A box of cells of a grid. Internal to kernel/voids.
#pragma once

#include "kernel/geometry/voxel_grid.h"

namespace rubble {

struct CellBox {
  Cell first, last;  // inclusive; empty where first > last

  bool empty() const { return first[0] > last[0] || first[1] > last[1] || first[2] > last[2]; }
  // Its cells as a grid of their own: only indices have a meaning there.
  VoxelGrid grid() const {
    VoxelGrid own;
    for (std::size_t k = 0; k < 3; ++k) own.size[k] = last[k] - first[k] + 1;
    return own;
  }
};

// Indices of the cells of a box within its grid, ascending.
class BoxWalk {
 public:
  BoxWalk(const VoxelGrid& grid, const CellBox& box) : grid_(grid), box_(box), next_(box.first) { begin_row(); }

  std::size_t next() {
    if (at_ == end_) {
      next_[1] = next_[1] < box_.last[1] ? next_[1] + 1 : (++next_[2], box_.first[1]);
      begin_row();
    }
    return at_++;
  }

 private:
  void begin_row() {
    at_ = grid_.index(next_);
    end_ = at_ + std::size_t(box_.last[0] - box_.first[0] + 1);
  }

  const VoxelGrid& grid_;
  const CellBox box_;
  Cell next_;  // the first of the row
  std::size_t at_ = 0, end_ = 0;
};

}  // namespace rubble
