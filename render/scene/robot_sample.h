// Readings of the sensors of a robot: joint encoders, motor torques, contacts, odometry.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct RobotSample {
  struct Wrench {
    Vec3 force, moment;  // unit: N, N m
  };
  // Dead reckoning from belts or wheels.
  struct Odometry {
    Pose odom_from_base;             // level; unit: m
    double linear = 0, angular = 0;  // forwards, counter-clockwise; unit: m/s, rad/s
    std::array<std::array<double, 3>, 3> covariance{};  // of x, y and yaw; unit: m2, m rad, rad2
    double linear_variance = 0, angular_variance = 0;   // unit: (m/s)2, (rad/s)2
  };

  std::int64_t stamp_ns = 0;
  int sensor = 0;  // number among the recording's robots
  // By joint of RobotRecord; units: rad, rad/s and N m for hinges, m, m/s and N for sliders. Efforts are of motors.
  std::vector<double> positions, speeds, efforts;
  std::vector<Pose> parent_from_child;  // by joint: the child's frame at these positions; unit: m
  std::vector<Wrench> contacts;  // by link: sum of all contacts, in its frame, about its origin
  std::optional<Odometry> odometry;
  // True pose of the first link in the world, and its velocities in its own frame; unit: m, m/s, rad/s
  Pose world_from_base;
  Vec3 linear_velocity, angular_velocity;
};

}  // namespace rubble
