// The links that sensors of contact feel.
#pragma once

#include <vector>

#include "app/robots/mission_robot.h"
#include "app/sensors/robot_readings.h"

namespace rubble {

// By sensor of the scenario; empty for one that rides on no robot. Throws InputError: no such link.
std::vector<FeltLinks> find_felt_links(const Scenario& scenario, const std::vector<MissionRobot>& robots);

}  // namespace rubble
