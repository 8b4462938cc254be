// Which parts are near each other: enlarged boxes in hashed uniform grids (Teschner et al. 2003), a fine one and, for what
// is large or fast, coarser ones.
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
  BroadPhase();

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

  // Calls visit(other) for every item whose enlarged box overlaps that of `item`: first large ones, in the order of their
  // list; then the others.
  template <typename Visit>
  void query(int item, Visit&& visit) {
    ++stamp_;
    seen_[item] = stamp_;
    for (std::int32_t other : find_large(item)) visit(int(other));
    if (levels_[item] != kFine) {
      for (std::int32_t other : find_small(item)) visit(int(other));
      return;
    }
    const Aabb& box = boxes_[item];
    for_cells(fine_, kCell, box, [&](const Bucket& bucket) {
      for (std::int32_t other : bucket)
        if (is_new(other) && overlap(box, boxes_[other])) visit(int(other));
    });
  }

  const Aabb& box(int item) const { return boxes_[item]; }
  static bool overlap(const Aabb& a, const Aabb& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
  }

  // Calls visit for each member, to write and read them (world_serialization.h).
  template <typename Self, typename Visit>
  static void each_field(Self& self, Visit&& visit) {
    visit(self.fine_), visit(self.coarse_), visit(self.large_), visit(self.boundless_);
    visit(self.places_), visit(self.boxes_), visit(self.present_), visit(self.levels_), visit(self.seen_), visit(self.found_), visit(self.stamp_);
    visit(self.small_count_);
  }

 private:
  using Bucket = std::vector<std::int32_t>;
  struct Range {
    std::int64_t min[3], max[3];
    double cells() const;
  };
  static constexpr double kCell = 0.6;  // of the fine grid; unit: m; about the size of a piece
  static constexpr int kCoarse = 3;     // coarse grids
  static constexpr double kCoarseCells[kCoarse] = {2.4, 9.6, 38.4};  // unit: m
  // Where an item is, if not in a coarse grid.
  static constexpr std::uint8_t kFine = 255, kNoGrid = kCoarse;

  static Range range_of(const Aabb& box, double cell);
  static std::size_t hash(std::int64_t x, std::int64_t y, std::int64_t z);
  static std::uint8_t choose_level(const Aabb& box);

  template <typename Visit>
  static void for_cells(std::vector<Bucket>& grid, double cell, const Aabb& box, Visit&& visit) {
    const Range r = range_of(box, cell);
    const std::size_t mask = grid.size() - 1;
    for (std::int64_t z = r.min[2]; z <= r.max[2]; ++z) {
      for (std::int64_t y = r.min[1]; y <= r.max[1]; ++y) {
        for (std::int64_t x = r.min[0]; x <= r.max[0]; ++x) visit(grid[hash(x, y, z) & mask]);
      }
    }
  }
  void insert(int item);
  void erase(int item);
  bool is_new(std::int32_t other) {
    const bool unseen = seen_[other] != stamp_;
    seen_[other] = stamp_;
    return unseen;
  }
  void add_found(const Bucket& items, const Aabb& box);
  const Bucket& find_large(int item);
  const Bucket& find_small(int item);

  std::vector<Bucket> fine_;             // a power of two of them, as in each grid
  std::vector<Bucket> coarse_[kCoarse];  // empty until something is in it
  Bucket large_;                         // all that are not in the fine grid
  Bucket boundless_;                     // of these, what is in no grid
  std::vector<std::int32_t> places_;     // of each item in large_
  std::vector<Aabb> boxes_;
  std::vector<std::uint8_t> present_, levels_;
  std::vector<std::uint32_t> seen_;
  Bucket found_;
  std::uint32_t stamp_ = 0;
  std::int32_t small_count_ = 0;  // in the fine grid
};

}  // namespace rubble
