// Mistakes in the cameras of a mission that no single key shows; for find_mistakes().
#pragma once

#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "scripting/scenario/mission_form.h"

namespace rubble {

void check_cameras(const Scenario& scenario, std::vector<Diagnostic>& mistakes);
// Where a mission has both the table of several and the key of one.
void check_forms(const MissionForm& form, std::vector<Diagnostic>& mistakes);
// Of topics and frames of all sensors: what is no name, and what is the name of another.
void check_sensor_names(const Scenario& scenario, std::vector<Diagnostic>& mistakes);
// TF frames of the sensors and of what is always there: links of robots may not have these names.
std::vector<std::string> list_sensor_frames(const Scenario& scenario);

}  // namespace rubble
