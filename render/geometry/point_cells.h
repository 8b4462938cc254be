// Points by the cell of space that they lie in, to find those near a place.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

class PointCells {
 public:
  struct Point {
    Vec3f position;  // unit: m
    std::uint32_t index = 0;
  };

  // cell: its side; unit: m
  PointCells(float cell, const std::vector<Point>& points) : cell_(cell) {
    entries_.reserve(points.size());
    for (const Point& p : points) entries_.push_back({cell_of(p.position), p.index});
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.cell < b.cell; });
    for (std::uint32_t i = 0; i < entries_.size(); ++i)
      if (rows_.empty() || rows_.back().number != row_of(entries_[i].cell)) rows_.push_back({row_of(entries_[i].cell), i});
    rows_.push_back({~std::uint64_t{0}, std::uint32_t(entries_.size())});
  }

  // A number of the cell that a place lies in. Places in one cell are near the same points.
  std::uint64_t cell_of(const Vec3f& p) const { return number(at(p.x), at(p.y), at(p.z)); }

  // Calls visit(index) for all in the cells up to `reach` away from the place's own along each axis: cell by cell, and
  // those of one cell in the order in which they were given.
  template <typename Visit>
  void near(const Vec3f& p, int reach, const Visit& visit) const {
    const int x = at(p.x), y = at(p.y), z = at(p.z);
    for (int k = z - reach; k <= z + reach; ++k) {
      const std::uint64_t last_row = row_of(number(x, y + reach, k));
      for (const Row* row = first_row(row_of(number(x, y - reach, k))); row->number <= last_row; ++row)
        visit_row(*row, x - reach, x + reach, visit);
    }
  }

 private:
  struct Entry {
    std::uint64_t cell;
    std::uint32_t index;
  };
  // Cells that differ in x alone.
  struct Row {
    std::uint64_t number;
    std::uint32_t first;  // entry; those of the row end where the next one's begin
  };
  static constexpr int kAxisBits = 21;
  static constexpr int kMiddle = 1 << (kAxisBits - 1);  // number of the cell at zero along an axis

  // What is too far away lies in the last cell.
  int at(float x) const { return int(std::floor(std::clamp(x / cell_, float(-kMiddle / 2), float(kMiddle / 2)))); }
  static std::uint64_t number(int x, int y, int z) {
    return std::uint64_t(x + kMiddle) | std::uint64_t(y + kMiddle) << kAxisBits |
           std::uint64_t(z + kMiddle) << 2 * kAxisBits;
  }
  static std::uint64_t row_of(std::uint64_t cell) { return cell >> kAxisBits; }
  const Row* first_row(std::uint64_t number) const {
    const auto before = [](const Row& row, std::uint64_t wanted) { return row.number < wanted; };
    return &*std::lower_bound(rows_.begin(), rows_.end() - 1, number, before);
  }

  template <typename Visit>
  void visit_row(const Row& row, int from, int to, const Visit& visit) const {
    const std::uint64_t row_cell = row.number << kAxisBits;
    const std::uint64_t first = row_cell | std::uint64_t(from + kMiddle), last = row_cell | std::uint64_t(to + kMiddle);
    const auto end = entries_.begin() + (&row + 1)->first;
    const auto before = [](const Entry& e, std::uint64_t wanted) { return e.cell < wanted; };
    for (auto e = std::lower_bound(entries_.begin() + row.first, end, first, before); e != end && e->cell <= last; ++e)
      visit(e->index);
  }

  float cell_;                  // unit: m
  std::vector<Entry> entries_;  // by cell
  std::vector<Row> rows_;       // of entries, by number; a last one that ends them
};

}  // namespace rubble
