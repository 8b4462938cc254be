// The rules of the search benchmark, version 1: what the robot is, what it senses, how long it has, what counts.
// docs/explanation/search.md states them for people; results are comparable only under the same version.
#pragma once

#include <cstdint>

#include "kernel/base/math.h"

namespace rubble {

inline constexpr int kSearchVersion = 1;

struct SearchRules {
  double radius = 0.15;      // of the robot, a ball that flies; unit: m
  double speed = 0.5;        // at most; unit: m/s
  double turn_rate = 1.0;    // at most; unit: rad/s
  double period = 0.2;       // of a step; unit: s
  double time_limit = 300;   // simulated; unit: s
  int width = 80, height = 60;  // of depth and thermal picture, which look forwards; unit: pixel
  double fov_deg = 90;          // across; unit: degree
  double max_range = 8;         // of depth; unit: m
  double report_within = 0.5;   // of the middle of a trunk: the report counts; unit: m
  int reports_each = 2;         // reports that are allowed, for each victim
  double ambient = 288.15;      // temperature of the debris; unit: K
  double body = 301.15;         // of clothes on a living body, as a thermal camera sees them; unit: K
  double thermal_noise = 0.05;  // standard deviation of a pixel; unit: K
};

struct SearchCommand {
  Vec3 velocity;    // forwards, left, up, in the body; unit: m/s
  double turn = 0;  // to the left; unit: rad/s
};

// Upright, the camera at its middle, looking forwards.
struct SearchPose {
  Vec3 position;   // unit: m
  double yaw = 0;  // unit: rad
  Pose world_from_body() const;
};

}  // namespace rubble
