// What the robots of a mission did.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "app/measures/metrics.h"
#include "app/scene/moving_scene.h"
#include "app/sensors/robot_readings.h"
#include "io/recording/recording.h"
#include "kernel/robot/robot_run.h"

namespace rubble {

// Results of the robots of a mission; empty without robots.
struct DrivenRobots {
  std::int64_t start_ns = 0;         // stamp of their time 0
  RobotTrack moved;                  // motion of the robots and of the pieces that they moved
  RobotReadings readings;            // of their sensors, and the path of a rig on a robot
  std::vector<RobotRecord> records;  // for recorders
  std::optional<RigMount> mount;     // for recorders
  std::vector<RobotSummary> summaries;  // by robot
  int pieces_moved = 0;              // of the pile, by more than 1 cm
  Metrics metrics;                   // robot_distance_m and so on
};

}  // namespace rubble
