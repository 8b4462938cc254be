// When the robots of a mission run, and what carries sensors.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "scripting/robots/robot_item.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

enum class DebrisMotion { free, fixed };

// When and how the robots of a mission run.
struct RobotRunScenario {
  double duration = 10;     // unit: s; range: above 0, to 86400
  double control_hz = 60;   // range: 1 to 240
  DebrisMotion debris = DebrisMotion::free;
  bool live_light = false;  // light of what may move is computed for every image, as while a person drives
};

class Schema;
struct Scenario;

// at: what the keys begin with: "imu.", or nothing.
void add_ride_keys(Schema& keys, const std::string& at, Carrier& ride);
// The scenario must outlive the schema.
void add_robot_keys(Schema& keys, Scenario& scenario);
// How `senses` names the colours of a camera; its name alone is its depth.
inline std::string colour_sense(const std::string& camera) { return camera + ".rgb"; }
void check_robots(const Scenario& scenario, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
