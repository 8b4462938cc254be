// A number for each cell of a grid, or for some cells alone.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "kernel/voids/cell_slots.h"

namespace rubble {

class CellClearance {
 public:
  CellClearance() = default;
  explicit CellClearance(std::size_t cells) : values_(cells) {}  // of each cell: 0

  // Of a cell whose number was not kept: 0.
  float operator[](std::size_t cell) const {
    const std::size_t at = place(cell);
    return at == kNoSlot ? 0 : values_[at];
  }
  // Of the cell whose number in kept() that is.
  float of_number(std::size_t number) const { return values_[number]; }
  // Without effect on a cell whose number is not kept.
  void set(std::size_t cell, float value) {
    const std::size_t at = place(cell);
    if (at != kNoSlot) values_[at] = value;
  }
  bool keeps(std::size_t cell) const { return place(cell) != kNoSlot; }
  bool is_sparse() const { return kept_ != nullptr; }
  // The cells whose numbers are kept; null: all.
  const std::shared_ptr<const CellSlots>& kept() const { return kept_; }
  std::vector<float>& of_all() { return values_; }  // of all cells in turn; not of a sparse one

  // Forgets all others. Without any so far, each is 0. wanted: of each cell.
  void keep(const std::vector<bool>& wanted) {
    auto kept = std::make_shared<const CellSlots>(wanted.size(), [&](std::size_t i) { return wanted[i]; });
    std::vector<float> values(kept->count());
    for (std::size_t i = 0; i < wanted.size() && !values_.empty(); ++i)
      if (wanted[i]) values[(*kept)[i]] = (*this)[i];
    values_ = std::move(values), kept_ = std::move(kept);
  }
  // Forgets all but some cells, and numbers these anew. place_before: its next() is that of each in turn, ascending.
  template <typename Walk>
  void renumber(std::size_t cells, const Walk& places_before) {
    Walk before = places_before;
    std::size_t count = 0;
    std::shared_ptr<const CellSlots> kept;
    const auto take = [&](std::size_t) {
      const std::size_t at = place(before.next());
      if (at != kNoSlot) values_[count++] = values_[at];
      return at != kNoSlot;
    };
    if (kept_)
      kept = std::make_shared<const CellSlots>(cells, take);
    else
      for (std::size_t i = 0; i < cells; ++i) take(i);
    values_.resize(count), kept_ = std::move(kept);
  }

 private:
  std::size_t place(std::size_t cell) const { return kept_ ? (*kept_)[cell] : cell; }

  std::vector<float> values_;
  std::shared_ptr<const CellSlots> kept_;
};

}  // namespace rubble
