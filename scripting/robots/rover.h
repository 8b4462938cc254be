// The rover: four driven wheels. Figures and their sources: docs/reference/robots.md. SI.
#pragma once

#include "kernel/model/robot.h"

namespace rubble {

// Four driven wheels, steered by skidding. Origin: on the ground between the wheels. Joints: front left,
// front right, rear left, rear right wheel; positive drives forwards.
struct RoverOptions {
  double friction = 0.8;  // range: 0 to 2
  double speed = 1.0;     // unit: m/s; range: 0.01 to 5
};
RobotModel make_rover(const RoverOptions& options = {});

inline constexpr double kRoverTrackDistance = 0.376;  // unit: m
inline constexpr double kRoverWheelRadius = 0.098;    // unit: m

// side: 1 where the wheel's outside looks along Y, else -1.
TriangleMesh make_rover_wheel_looks(double radius, double width, double side);
TriangleMesh make_rover_body_looks();

}  // namespace rubble
