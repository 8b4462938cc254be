// From depth pictures to what is known of space: by rays over a grid, or by OctoMap. Internal to app/search.
#pragma once

#include <functional>

#include "app/search/exploration_map.h"

namespace rubble {

// Takes in what is seen.
using DepthMapping = std::function<void(const SearchObservation&, ExplorationMap&)>;

// What a ray passed is free, unless it was solid; where it ended is solid for good. Right as long as depth is exact.
DepthMapping make_ray_mapping(const SearchRules& rules);
// Each cell has a probability of OctoMap's occupancy tree: what was seen may be seen otherwise later.
DepthMapping make_octomap_mapping(const SearchRules& rules);

}  // namespace rubble
