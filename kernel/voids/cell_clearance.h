// A number for each cell of a grid, or for some cells alone.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kernel/voids/cell_slots.h"

namespace rubble {

class CellClearance {
 public:
  // Of a cell whose number was not kept: 0.
  float operator[](std::size_t cell) const {
    const std::size_t at = place(cell);
    return at == kNoSlot ? 0 : values_[at];
  }
  // Without effect on a cell whose number is not kept.
  void set(std::size_t cell, float value) {
    const std::size_t at = place(cell);
    if (at != kNoSlot) values_[at] = value;
  }

  // The numbers of all cells in turn, 0 where none was kept. cells: of the grid.
  std::vector<float>& of_all(std::size_t cells) {
    if (is_sparse_) {
      std::vector<float> all(cells);
      for (std::size_t i = 0; i < cells; ++i) all[i] = (*this)[i];
      values_ = std::move(all), kept_ = {}, is_sparse_ = false;
    }
    values_.resize(cells);
    return values_;
  }
  // Forgets all others of what of_all() gave. wanted: of each cell.
  void keep(const std::vector<bool>& wanted) {
    CellSlots kept(wanted.size(), [&](std::size_t i) { return wanted[i]; });
    std::vector<float> values;
    values.reserve(kept.count());
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i]) values.push_back(values_[i]);
    values_ = std::move(values), kept_ = std::move(kept), is_sparse_ = true;
  }

 private:
  std::size_t place(std::size_t cell) const { return is_sparse_ ? kept_[cell] : cell; }

  std::vector<float> values_;
  CellSlots kept_;
  bool is_sparse_ = false;
};

}  // namespace rubble
