// Which parts are near each other: enlarged boxes in hashed uniform grids (Teschner et al. 2003), a fine one and, for what
// is large or fast, coarser ones. A part is in one grid, and is looked for in all.
//
// A part is looked up again only when it leaves its enlarged box, so resting parts cost nothing.
// The order of the pairs depends on the order of the calls alone.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

class BroadPhase {
 public:
  // Adds an item with the next number.
  int add();
  // Whether an item's enlarged box still holds it.
  bool holds(int item, const Aabb& tight) const {
    const Aabb& old = boxes_[item];
    return present_[item] && old.min.x <= tight.min.x && old.min.y <= tight.min.y &&
           old.min.z <= tight.min.z && old.max.x >= tight.max.x && old.max.y >= tight.max.y &&
           old.max.z >= tight.max.z;
  }
  // Puts an item where `tight` is, in a new enlarged box. `motion`: how far it will go in a few
  // steps; the box reaches ahead. Returns the box before; empty: there was none.
  Aabb update(int item, const Aabb& tight, const Vec3& motion);
  void remove(int item);

  // Calls visit(other) for every item whose enlarged box overlaps that of `item`.
  template <typename Visit>
  void query(int item, Visit&& visit) {
    ++stamp_;
    seen_[item] = stamp_;
    const Aabb& box = boxes_[item];
    const auto consider = [&](std::int32_t other) {
      if (seen_[other] == stamp_) return;
      seen_[other] = stamp_;
      if (overlap(box, boxes_[other])) visit(int(other));
    };
    for (int level = 0; level < kGrids; ++level) {
      if (counts_[level] == 0) continue;
      if (range_of(box, kCells[level]).cells() < double(boxes_.size())) {
        for_cells(level, box, [&](const Bucket& bucket) {
          for (std::int32_t other : bucket) consider(other);
        });
        continue;
      }
      for (std::int32_t other = 0; other < std::int32_t(boxes_.size()); ++other)
        if (present_[other] && levels_[other] == level) consider(other);
    }
    for (std::int32_t other : boundless_) consider(other);
  }

  const Aabb& box(int item) const { return boxes_[item]; }
  static bool overlap(const Aabb& a, const Aabb& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
  }

  // Calls visit for each member, to write and read them (world_serialization.h).
  template <typename Self, typename Visit>
  static void each_field(Self& self, Visit&& visit) {
    visit(self.grids_), visit(self.counts_), visit(self.boundless_), visit(self.boxes_), visit(self.present_);
    visit(self.levels_), visit(self.seen_), visit(self.stamp_);
  }

 private:
  using Bucket = std::vector<std::int32_t>;
  struct Range {
    std::int64_t min[3], max[3];
    double cells() const;
  };
  static constexpr int kGrids = 4;  // each with cells four times as wide as the one before
  static constexpr double kCells[kGrids] = {0.6, 2.4, 9.6, 38.4};  // the finest: about the size of a piece; unit: m

  static Range range_of(const Aabb& box, double cell);
  static std::size_t hash(std::int64_t x, std::int64_t y, std::int64_t z);
  static std::uint8_t choose_level(const Aabb& box);

  template <typename Visit>
  void for_cells(int level, const Aabb& box, Visit&& visit) {
    std::vector<Bucket>& grid = grids_[level];
    const Range r = range_of(box, kCells[level]);
    const std::size_t mask = grid.size() - 1;
    for (std::int64_t z = r.min[2]; z <= r.max[2]; ++z) {
      for (std::int64_t y = r.min[1]; y <= r.max[1]; ++y) {
        for (std::int64_t x = r.min[0]; x <= r.max[0]; ++x) visit(grid[hash(x, y, z) & mask]);
      }
    }
  }
  void insert(int item);
  void erase(int item);

  std::vector<Bucket> grids_[kGrids];   // a power of two of them; empty until something is in it
  std::int32_t counts_[kGrids] = {};    // of the items in each grid
  Bucket boundless_;                    // what is in no grid
  std::vector<Aabb> boxes_;
  std::vector<std::uint8_t> present_, levels_;  // level: the item's grid; kGrids: none
  std::vector<std::uint32_t> seen_;
  std::uint32_t stamp_ = 0;
};

}  // namespace rubble
