// What sensors have to do with the links that carry them.
#pragma once

#include <string>
#include <vector>

#include "app/robots/mission_robot.h"
#include "app/sensors/robot_readings.h"

namespace rubble {

// Sensors that stand inside of the link that carries them, where their rays meet nothing but its inside.
// Warnings of cameras and sensors that cast rays. Throws InputError as find_link() does.
std::vector<std::string> find_buried_sensors(const Scenario& scenario, const std::vector<MissionRobot>& robots);

// Throws InputError for a link that carries a sensor or the rig, or is felt, and that its robot lacks.
void check_ridden_links(const Scenario& scenario, const std::vector<MissionRobot>& robots);

// By sensor of the scenario; empty for one that rides on no robot. Throws InputError: no such link.
std::vector<FeltLinks> find_felt_links(const Scenario& scenario, const std::vector<MissionRobot>& robots);

}  // namespace rubble
