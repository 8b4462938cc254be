// What the navigator has to know of a robot before it drives it.
#pragma once

#include <string>
#include <vector>

#include "io/mrpt/reactive_navigator.h"

namespace rubble {

struct RobotKindOfNavigator {
  std::string name;
  std::vector<NavigatorSlice> shape;
  double plan_radius = 0.36;  // of the disc that a global planner plans for; unit: m
  // What skids turns by this share of what tracks or wheels would give (docs/reference/robots.md): commands are divided by it, and
  // turns of odometry multiplied.
  double turn_share = 1;
};

// The bundled robots that have odometry: crawler, with its flippers up, and rover.
const std::vector<RobotKindOfNavigator>& known_robots();

}  // namespace rubble
