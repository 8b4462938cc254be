#include "kernel/voids/widest_path.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kLevelsPerVoxel = 16;

class Flood {
 public:
  explicit Flood(const VoidSpace& space) : space_(space) {
    paths_.cells = CellSlots(space.kind.size(),
                             [&](std::size_t i) { return space.kind[i] == CellKind::free_void; });
    paths_.radius.assign(paths_.cells.count(), 0);
    paths_.narrowest.assign(paths_.cells.count(), kNoCell);
  }

  WidestPaths run() {
    enter_from_outside();
    for (std::size_t level = levels_.size(); level-- > 0;) {
      // Cells may be added to this level, never to a higher one, while it is worked through.
      for (std::size_t k = 0; k < levels_[level].size(); ++k) {
        const std::size_t i = levels_[level][k];
        if (find_level(paths_.radius[paths_.cells[i]]) == level)
          spread(i);  // else a wider way was found since
      }
      levels_[level] = {};
    }
    return std::move(paths_);
  }

 private:
  void enter_from_outside() {
    for (std::size_t i = 0; i < space_.kind.size(); ++i) {
      if (space_.kind[i] != CellKind::free_void) continue;
      float widest = -1;
      for_each_neighbour(space_.grid, i, [&](std::size_t k) {
        if (space_.kind[k] == CellKind::outside) widest = std::max(widest, space_.clearance[k]);
      });
      if (widest >= 0) reach(i, std::min(widest, space_.clearance[i]), std::uint32_t(i));
    }
  }

  std::size_t find_level(float radius) const {
    return std::size_t(std::floor(radius / space_.grid.voxel * kLevelsPerVoxel));
  }

  void reach(std::size_t i, float radius, std::uint32_t narrowest) {
    const std::size_t slot = paths_.cells[i];
    if (paths_.narrowest[slot] != kNoCell && paths_.radius[slot] >= radius) return;
    paths_.radius[slot] = radius;
    paths_.narrowest[slot] = narrowest;
    const std::size_t level = find_level(radius);
    if (levels_.size() <= level) levels_.resize(level + 1);
    levels_[level].push_back(std::uint32_t(i));
  }

  void spread(std::size_t i) {
    const float radius = paths_.radius[paths_.cells[i]];
    const std::uint32_t narrowest = paths_.narrowest[paths_.cells[i]];
    for_each_neighbour(space_.grid, i, [&](std::size_t k) {
      if (space_.kind[k] != CellKind::free_void) return;
      const float here = space_.clearance[k];
      if (here < radius)
        reach(k, here, std::uint32_t(k));
      else
        reach(k, radius, narrowest);
    });
  }

  const VoidSpace& space_;
  WidestPaths paths_;
  std::vector<std::vector<std::uint32_t>> levels_;
};

}  // namespace

WidestPaths find_widest_paths(const VoidSpace& space) { return Flood(space).run(); }

}  // namespace rubble
