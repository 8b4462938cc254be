// What light meets in the air on its way.
#pragma once

#include <array>
#include <vector>

#include "render/lighting/radiance_grid.h"
#include "render/media/medium.h"

namespace rubble {

// The mean air at the points of a grid, without billows and puffs, as it turns light: see forward_share().
struct AirMatter {
  std::vector<float> extinction;                      // unit: 1/m
  std::vector<std::array<float, kOrders>> scattered;  // of what it takes, what it gives back of each order
};
AirMatter turning_matter(const Air& air, const AirGrid& grid);

}  // namespace rubble
