// The LiDARs of a mission, ready to scan.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/sensors/robot_readings.h"
#include "render/lidar/lidar_world.h"
#include "render/media/medium.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// path: of the rig, from start_ns on; robots: what carries those that are not on the rig. world: what rays meet.
// medium: what hangs in the air of the scene. last_ns: no scan begins later. Empty where the mission has no LiDAR.
std::vector<std::unique_ptr<Sensor>> make_lidar_sensors(const std::vector<LidarScenario>& lidars,
                                                        const std::shared_ptr<LidarWorld>& world, const Medium& medium,
                                                        std::uint64_t noise_seed, std::int64_t start_ns, std::int64_t last_ns,
                                                        std::shared_ptr<const MotionPath> path,
                                                        const RobotReadings& robots, int threads);

}  // namespace rubble
