#include "app/eval/scores/point_grid.h"

#include <algorithm>

#include "app/eval/scores/space_key.h"

namespace rubble {

PointGrid::PointGrid(const std::vector<Vec3>& points, double cell) : cell_(cell) {
  for (const Vec3& p : points)
    if (has_space_key(p)) points_.push_back({space_key_of(p, cell), p});
  std::sort(points_.begin(), points_.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
}

double PointGrid::find_distance(const Vec3& place) const {
  if (!has_space_key(place)) return cell_;
  double nearest = cell_;
  const std::int64_t x = space_index(place.x, cell_), y = space_index(place.y, cell_),
                     z = space_index(place.z, cell_);
  for (std::int64_t i = x - 1; i <= x + 1; ++i)
    for (std::int64_t j = y - 1; j <= y + 1; ++j) {
      // The three cells above one another are neighbours in the list.
      const auto first = std::lower_bound(
          points_.begin(), points_.end(), space_key(i, j, z - 1),
          [](const auto& point, std::int64_t key) { return point.first < key; });
      const std::int64_t last = space_key(i, j, z + 1);
      for (auto at = first; at != points_.end() && at->first <= last; ++at)
        nearest = std::min(nearest, distance(at->second, place));
    }
  return nearest;
}

}  // namespace rubble
