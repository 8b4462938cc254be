// From /cmd_vel, /joy and /joint_trajectory to a DriveInput. Knows nothing of networks.
#pragma once

#include "app/drive/drive_input.h"
#include "io/live/drive_commands.h"

namespace rubble {

// The sticks, pads and buttons of a sensor_msgs/Joy do what those of a gamepad at the window do
// (docs/how_to/drive.md), by the numbers that ROS's joy_node gives an Xbox controller on Linux.
class RemoteControls {
 public:
  // What came before this step of so many seconds. The last Twist holds for half a second of
  // simulation time, so that the camera stops when its driver is gone; the last Joy for as long as
  // anybody publishes, because joy_node says nothing while nothing changes.
  void hear(const DriveCommands& commands, double seconds);
  // What is asked for now, beside what else is. Each button and each trajectory is given once.
  void add_to(DriveInput& input);

 private:
  void hear(const JoyCommand& joy);

  TwistCommand twist_;
  double twist_age_ = 0;  // unit: s
  JoyCommand joy_;
  std::vector<DriveAction> actions_;
  std::vector<JointTrajectoryCommand> trajectories_;
};

}  // namespace rubble
