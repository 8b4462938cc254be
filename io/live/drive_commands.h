// What programs ask of a camera or a robot that is driven, over the network: geometry_msgs/Twist,
// sensor_msgs/Joy, trajectory_msgs/JointTrajectory and sensor_msgs/JointState, as they are on ROS's wires.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/ros/ros_wire.h"
#include "kernel/base/math.h"

namespace rubble {

struct TwistCommand {
  Vec3 linear;   // in the camera body frame (X forward, Y left, Z up); unit: m/s
  Vec3 angular;  // about its axes; unit: rad/s
};

// How long a twist holds, so that what is driven stops when its driver is gone; unit: s, of simulation time
inline constexpr double kTwistHolds = 0.5;

struct JoyCommand {
  std::vector<float> axes;  // range: -1 to 1, to the left and up positive
  std::vector<std::int32_t> buttons;  // 0 or 1
};

struct JointTrajectoryCommand {
  struct Point {
    std::vector<double> positions, velocities;  // by joint; unit: rad, rad/s; slider m, m/s
    double time = 0;                            // from the start; unit: s
  };
  std::vector<std::string> joints;
  std::vector<Point> points;
};

// All that has come since the last look, in the order in which it came.
struct DriveCommands {
  std::vector<TwistCommand> twists;  // of /cmd_vel
  std::vector<JoyCommand> joys;      // of /joy
  std::vector<JointTrajectoryCommand> trajectories;  // of /joint_trajectory
  bool joy_connected = false;        // whether anybody publishes /joy now
};

// All throw RunError when the bytes are no such message, or hold what is not a finite number.
TwistCommand read_twist(ros::Version version, std::string_view message);
JoyCommand read_joy(ros::Version version, std::string_view message);
// Stamp, accelerations and efforts are left out. What joints there are is not known here.
JointTrajectoryCommand read_joint_trajectory(ros::Version version, std::string_view message);
// sensor_msgs/JointState as a command: positions at once. Velocities and efforts are left out; without positions RunError.
JointTrajectoryCommand read_joint_command(ros::Version version, std::string_view message);

}  // namespace rubble
