// Points by the cell they are in, for asking what is near.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

class PointGrid {
 public:
  // Points farther from the origin than kSpaceReach (space_key.h) are left out.
  PointGrid(const std::vector<Vec3>& points, double cell);

  // From a place to the nearest point, or `cell` when none is nearer than that; unit: m.
  double find_distance(const Vec3& place) const;

 private:
  double cell_;
  std::vector<std::pair<std::int64_t, Vec3>> points_;  // ascending by cell
};

}  // namespace rubble
