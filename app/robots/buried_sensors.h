// Sensors that stand inside of the link that carries them, where their rays meet nothing but its inside.
#pragma once

#include <string>
#include <vector>

#include "app/robots/mission_robot.h"

namespace rubble {

// Warnings of cameras and sensors that cast rays. Throws InputError as find_link() does.
std::vector<std::string> find_buried_sensors(const Scenario& scenario, const std::vector<MissionRobot>& robots);

}  // namespace rubble
