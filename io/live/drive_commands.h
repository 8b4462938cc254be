// What programs ask of a camera that is driven, over the network: geometry_msgs/Twist and
// sensor_msgs/Joy, as they are on ROS's wires.
#pragma once

#include <string_view>
#include <vector>

#include "io/ros/ros_wire.h"
#include "kernel/base/math.h"

namespace rubble {

struct TwistCommand {
  Vec3 linear;   // in the camera body frame (X forward, Y left, Z up); unit: m/s
  Vec3 angular;  // about its axes; unit: rad/s
};

struct JoyCommand {
  std::vector<float> axes;  // range: -1 to 1, to the left and up positive
  std::vector<std::int32_t> buttons;  // 0 or 1
};

// All that has come since the last look, in the order in which it came.
struct DriveCommands {
  std::vector<TwistCommand> twists;  // of /cmd_vel
  std::vector<JoyCommand> joys;      // of /joy
  bool joy_connected = false;        // whether anybody publishes /joy now
};

// Both throw RunError when the bytes are no such message, or hold what is not a finite number.
TwistCommand read_twist(ros::Version version, std::string_view message);
JoyCommand read_joy(ros::Version version, std::string_view message);

}  // namespace rubble
