#include "app/measures/void_metrics.h"

#include <algorithm>

namespace rubble {

VoidSpaceOptions make_void_options(const VoidScenario& voids) {
  VoidSpaceOptions options;
  options.voxel = voids.voxel;
  options.rolling_radius = outside_radius_for(options.rolling_radius, voids.radius);
  return options;
}

void add_void_metrics(const VoidMap& map, double radius, Metrics& metrics) {
  const RobotVoids& robot =
      *std::find_if(map.robots.begin(), map.robots.end(),
                    [&](const RobotVoids& found) { return found.radius == radius; });
  double deepest = 0, way_in = 0;
  for (const Void& v : robot.voids) {
    deepest = std::max(deepest, v.depth);
    way_in = std::max(way_in, v.path_length);
  }
  metrics["void_volume_m3"] = map.void_volume;
  metrics["void_covered_m3"] = map.covered_volume;
  metrics["void_robot_m3"] = robot.volume;
  metrics["void_reachable_m3"] = robot.reachable_volume;
  metrics["void_count"] = double(robot.voids.size());
  metrics["void_depth_m"] = deepest;
  metrics["void_way_in_m"] = way_in;
}

}  // namespace rubble
