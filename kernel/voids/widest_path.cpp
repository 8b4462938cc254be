#include "kernel/voids/widest_path.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace rubble {
namespace {

constexpr double kLevelsPerVoxel = 16;

// The largest clearance of a cell outside beside this one; -1: there is none.
float calc_entry(const VoidSpace& space, std::size_t i) {
  float widest = -1;
  for_each_neighbour(space.grid, i, [&](std::size_t k) {
    if (space.kind[k] == CellKind::outside) widest = std::max(widest, space.clearance[k]);
  });
  return widest;
}

class Flood {
 public:
  explicit Flood(const VoidSpace& space) : space_(space) {
    const auto is_void = [&](std::size_t i) { return space.kind[i] == CellKind::free_void; };
    paths_.cells = space.clearance.kept();
    if (!paths_.cells) paths_.cells = std::make_shared<const CellSlots>(space.kind.size(), is_void);
    paths_.narrowest.assign(paths_.cells->count(), kNoCell);
    paths_.is_entry_narrower.assign(paths_.cells->count(), false);
  }

  WidestPaths run() {
    enter_from_outside();
    for (std::size_t level = levels_.size(); level-- > 0;) {
      // Cells may be added to this level, never to a higher one, while it is worked through.
      for (std::deque<std::uint32_t>& front = levels_[level]; !front.empty(); front.pop_front()) {
        const float radius = paths_.radius(space_, front.front());
        if (find_level(radius) == level) spread(front.front(), radius);  // else a wider way was found since
      }
      levels_.pop_back();
    }
    return std::move(paths_);
  }

 private:
  void enter_from_outside() {
    for (std::size_t i = 0; i < space_.kind.size(); ++i) {
      if (space_.kind[i] != CellKind::free_void) continue;
      const float entry = calc_entry(space_, i);
      if (entry < 0) continue;
      const std::size_t slot = (*paths_.cells)[i];
      const float here = find_clearance(i, slot);
      reach(i, slot, std::min(entry, here), std::uint32_t(i), entry < here);
    }
  }

  float find_clearance(std::size_t i, std::size_t slot) const {
    return space_.clearance.is_sparse() ? space_.clearance.of_number(slot) : space_.clearance[i];
  }

  std::size_t find_level(float radius) const {
    return std::size_t(std::floor(radius / space_.grid.voxel * kLevelsPerVoxel));
  }

  // Whether the way by that narrowest cell is as wide as the one that is known, without a look at any clearance.
  bool is_no_wider(std::size_t i, std::size_t slot, std::uint32_t narrowest, bool is_entry_narrower) const {
    const std::uint32_t known = paths_.narrowest[slot];
    if (known != narrowest && known != i) return false;
    return !paths_.is_entry_narrower[slot] || (known == narrowest && is_entry_narrower);
  }

  void reach(std::size_t i, std::size_t slot, float radius, std::uint32_t narrowest, bool is_entry_narrower) {
    if (paths_.narrowest[slot] != kNoCell && paths_.radius(space_, i) >= radius) return;
    paths_.narrowest[slot] = narrowest;
    paths_.is_entry_narrower[slot] = is_entry_narrower;
    const std::size_t level = find_level(radius);
    if (levels_.size() <= level) levels_.resize(level + 1);
    levels_[level].push_back(std::uint32_t(i));
  }

  void spread(std::size_t i, float radius) {
    const std::size_t from = (*paths_.cells)[i];
    const std::uint32_t narrowest = paths_.narrowest[from];
    const bool is_entry_narrower = paths_.is_entry_narrower[from];
    for_each_neighbour(space_.grid, i, [&](std::size_t k) {
      if (space_.kind[k] != CellKind::free_void) return;
      const std::size_t slot = (*paths_.cells)[k];
      if (is_no_wider(k, slot, narrowest, is_entry_narrower)) return;
      const float here = find_clearance(k, slot);
      if (here < radius)
        reach(k, slot, here, std::uint32_t(k), false);
      else
        reach(k, slot, radius, narrowest, is_entry_narrower);
    });
  }

  const VoidSpace& space_;
  WidestPaths paths_;
  std::deque<std::deque<std::uint32_t>> levels_;  // cells to spread from, by their radius
};

}  // namespace

float WidestPaths::radius(const VoidSpace& space, std::size_t cell) const {
  const std::size_t slot = (*cells)[cell];
  if (narrowest[slot] == kNoCell) return 0;
  return is_entry_narrower[slot] ? calc_entry(space, narrowest[slot]) : space.clearance[narrowest[slot]];
}

WidestPaths find_widest_paths(const VoidSpace& space) { return Flood(space).run(); }

}  // namespace rubble
