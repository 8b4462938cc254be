// The scanner of the navigation benchmark: a LiDAR of 32 rings that scans once a period.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "app/navigate/navigation_world.h"
#include "render/lidar/lidar.h"
#include "scripting/sensors/sensor_item.h"

namespace rubble {

using RangeScanner = Lidar;

// As a mission has it.
SensorItem make_range_scanner(const NavigationRules& rules, const std::string& name);

// On the robot of the benchmark. world_from_base: at that time since its first scan began; unit: s
RangeScanner make_range_scanner(const NavigationWorld& world, std::uint64_t seed, std::function<Pose(double time)> world_from_base);

}  // namespace rubble
