// What the robots of a mission sensed while they were driven, and whether one carries the rig.
#pragma once

#include <memory>
#include <vector>

#include "render/scene/robot_sample.h"
#include "scripting/trajectory/motion_path.h"

namespace rubble {

struct RobotReadings {
  std::vector<std::vector<RobotSample>> samples;  // by robot, in order of stamps
  std::shared_ptr<const MotionPath> ride;  // of the rig, on a link; none: it flies the trajectory
};

}  // namespace rubble
