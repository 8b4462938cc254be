// Which parts are near each other: enlarged boxes in hashed uniform grids (Teschner et al. 2003), a fine one and, for what
// is large or fast, coarser ones. A part is in one grid, and is looked for in all.
//
// A part is looked up again only when it leaves its enlarged box, so resting parts cost nothing.
#pragma once

#include <cstdint>
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
    return old.min.x <= tight.min.x && old.min.y <= tight.min.y &&
           old.min.z <= tight.min.z && old.max.x >= tight.max.x && old.max.y >= tight.max.y &&
           old.max.z >= tight.max.z;
  }
  // The box of an item that is in `tight`, enlarged. `motion`: how far it will go in a few steps; the box reaches ahead.
  static Aabb enlarge(const Aabb& tight, const Vec3& motion);
  // Puts an item in this enlarged box.
  void place(int item, const Aabb& box);
  void remove(int item);

  // The items whose enlarged boxes overlap that of `item`, ascending. Any number of threads may ask at a time.
  void find(int item, std::vector<std::int32_t>& found) const;

  // Enlarged; empty: the item is not there.
  const Aabb& box(int item) const { return boxes_[item]; }
  static bool overlap(const Aabb& a, const Aabb& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
  }

  // Calls visit for each member, to write and read them (world_serialization.h).
  template <typename Self, typename Visit>
  static void each_field(Self& self, Visit&& visit) {
    visit(self.grids_), visit(self.counts_), visit(self.boundless_), visit(self.boxes_), visit(self.present_);
    visit(self.levels_);
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

  // Buckets: std::vector<Bucket>, const or not.
  template <typename Buckets, typename Visit>
  static void for_cells(Buckets& grid, const Range& r, Visit&& visit) {
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
};

}  // namespace rubble
