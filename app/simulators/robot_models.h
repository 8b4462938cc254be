// Robots and cameras of a mission for simulators.
#pragma once

#include <string>
#include <vector>

#include "app/robots/mission_robot.h"
#include "io/scenes/sim_scene.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Each at the place and with the joints that the mission starts it with. notes: what of them is left out.
void add_robots(const Scenario& scenario, const std::vector<MissionRobot>& robots, SimScene& scene, std::vector<std::string>& notes);

// On the links that carry them, or where the flight begins. After add_robots().
void add_cameras(const Scenario& scenario, const std::vector<MissionRobot>& robots, SimScene& scene, std::vector<std::string>& notes);

}  // namespace rubble
