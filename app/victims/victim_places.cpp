#include "app/victims/victim_places.h"

#include <algorithm>
#include <cmath>

namespace rubble {

VoidSpaceOptions victim_space_options(double radius) {
  VoidSpaceOptions options;
  options.voxel = std::min(radius, std::max(0.05, 0.5 * radius));
  options.rolling_radius = outside_radius_for(options.rolling_radius, radius);
  return options;
}

std::vector<VictimPlace> find_victim_places(const VoidMap& map, VictimDifficulty difficulty) {
  std::vector<VictimPlace> all;
  for (const Void& v : map.robots.front().voids) {
    if (v.entrances.empty()) continue;
    const std::vector<double> ways = calc_ways_in(map.space, v);
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (std::isfinite(ways[i]) && ways[i] >= kLeastWayIn)
        all.push_back({map.space.grid.centre(v.places[i]), ways[i]});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const VictimPlace& a, const VictimPlace& b) { return a.way_in < b.way_in; });
  const auto third = std::size_t(difficulty);
  const auto at = [&](std::size_t k) { return all.begin() + std::ptrdiff_t(all.size() * k / 3); };
  return {at(third), at(third + 1)};
}

}  // namespace rubble
