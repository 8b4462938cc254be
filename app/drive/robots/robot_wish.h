// What a person or a program asks of a robot that is driven, as a command of its mission.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/model/robot.h"
#include "scripting/scenario/robot_scenario.h"

namespace rubble {

// In one step, whatever it was asked with.
struct RobotWish {
  // Held axes, range: -1 to 1: forwards, to the left, and the two that are left: flippers at the front and at the
  // rear (positive: up), of a vine the bend upwards.
  double forward = 0, yaw = 0, pitch = 0, roll = 0;
  Vec3 linear, angular;  // asked for in figures besides, in the base frame; unit: m/s, rad/s
  double speed = 0.3;    // of a full axis; unit: m/s
  std::vector<double> joints;  // positions of motors; empty: none are asked for; unit: rad, slider m
  std::vector<std::string> joint_names;  // whose they are; empty: all motors, in their order
};

// The command from `time` on, after the command `last`; flippers go on from where they were asked to be.
// seconds: since then. The item is the robot's.
RobotLeg make_leg(const RobotWish& wish, const RobotItem& robot, const RobotLeg& last, double time, double seconds);

// Whether both ask for the same.
bool same_command(const RobotLeg& a, const RobotLeg& b);

}  // namespace rubble
