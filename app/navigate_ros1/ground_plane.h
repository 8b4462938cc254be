// The ground about a robot, found in a cloud: odometry does not tell how the robot is tilted where it climbs.
#pragma once

#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// z = along_x x + along_y y + height, in the frame of the robot's base.
struct GroundPlane {
  double along_x = 0, along_y = 0, height = 0;  // slopes; unit: m
  // Takes points of the base to a frame with the same heading that is level with the ground, and z = 0 on it.
  Pose level_from_base() const;
};

// The plane on which most of what is low near the robot lies; `before` where there is too little of it, or it would be
// steeper than 25 degrees. points: in the frame of the base. before: of the last cloud.
GroundPlane find_ground(const std::vector<Vec3>& points, const GroundPlane& before);

}  // namespace rubble
