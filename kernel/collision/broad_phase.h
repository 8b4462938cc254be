// Which parts are near each other: enlarged boxes in a hashed uniform grid (Teschner et al. 2003).
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
  // steps; the box reaches ahead.
  void update(int item, const Aabb& tight, const Vec3& motion);
  void remove(int item);

  // Calls visit(other) for every item whose enlarged box overlaps that of `item`.
  template <typename Visit>
  void query(int item, Visit&& visit) {
    ++stamp_;
    seen_[item] = stamp_;
    const Aabb& box = boxes_[item];
    const auto look = [&](const std::vector<std::int32_t>& list) {
      for (std::int32_t other : list) {
        if (seen_[other] == stamp_) continue;
        seen_[other] = stamp_;
        if (overlap(box, boxes_[other])) visit(int(other));
      }
    };
    look(large_);
    if (is_large_[item]) {
      for (int other = 0; other < int(boxes_.size()); ++other) {
        if (!present_[other] || other == item || is_large_[other]) continue;
        if (overlap(box, boxes_[other])) visit(other);
      }
      return;
    }
    for_cells(box, [&](std::vector<std::int32_t>& cell) { look(cell); });
  }

  const Aabb& box(int item) const { return boxes_[item]; }
  static bool overlap(const Aabb& a, const Aabb& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
  }

  // Calls visit for each member, to write and read them (world_serialization.h).
  template <typename Self, typename Visit>
  static void each_field(Self& self, Visit&& visit) {
    visit(self.cells_), visit(self.large_), visit(self.boxes_), visit(self.present_);
    visit(self.is_large_), visit(self.seen_), visit(self.stamp_);
  }

 private:
  struct Range {
    std::int64_t min[3], max[3];
    std::int64_t cells() const;
  };
  static Range range_of(const Aabb& box);
  static std::size_t bucket(std::int64_t x, std::int64_t y, std::int64_t z);

  template <typename Visit>
  void for_cells(const Aabb& box, Visit&& visit) {
    const Range r = range_of(box);
    for (std::int64_t z = r.min[2]; z <= r.max[2]; ++z) {
      for (std::int64_t y = r.min[1]; y <= r.max[1]; ++y) {
        for (std::int64_t x = r.min[0]; x <= r.max[0]; ++x) visit(cells_[bucket(x, y, z)]);
      }
    }
  }
  void insert(int item);
  void erase(int item);

  std::vector<std::vector<std::int32_t>> cells_;
  std::vector<std::int32_t> large_;  // items that would fill too many cells
  std::vector<Aabb> boxes_;
  std::vector<std::uint8_t> present_, is_large_;
  std::vector<std::uint32_t> seen_;
  std::uint32_t stamp_ = 0;
};

}  // namespace rubble
