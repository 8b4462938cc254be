#include "app/navigate/obstacle_map.h"

#include <algorithm>
#include <cmath>

namespace rubble {

ObstacleMap::ObstacleMap(const Aabb& bounds, double voxel, int hits) : hits_(std::uint8_t(std::clamp(hits, 1, 255))) {
  grid_.voxel = voxel;
  grid_.corner = bounds.min;
  for (int k = 0; k < 3; ++k)
    grid_.size[std::size_t(k)] = std::max(1, int(std::ceil((bounds.max[k] - bounds.min[k]) / voxel)));
  seen_.assign(grid_.count(), 0);
}

void ObstacleMap::add(const Vec3& point) {
  const Cell cell = grid_.find_cell(point);
  if (!grid_.contains(cell)) return;
  std::uint8_t& seen = seen_[grid_.index(cell)];
  if (seen < hits_) ++seen;
}

bool ObstacleMap::is_occupied(const Vec3& point) const {
  const Cell cell = grid_.find_cell(point);
  return grid_.contains(cell) && seen_[grid_.index(cell)] == hits_;
}

std::vector<Vec3> ObstacleMap::find_around(const Vec3& place, double reach, double lowest, double highest) const {
  Cell first = grid_.find_cell({place.x - reach, place.y - reach, lowest});
  Cell last = grid_.find_cell({place.x + reach, place.y + reach, highest});
  for (std::size_t k = 0; k < 3; ++k) {
    first[k] = std::max(first[k], 0);
    last[k] = std::min(last[k], grid_.size[k] - 1);
  }
  std::vector<Vec3> found;
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        if (seen_[grid_.index({x, y, z})] == hits_) found.push_back(grid_.centre({x, y, z}));
  return found;
}

}  // namespace rubble
