// Mistakes in the cameras of a mission that no single key shows; for find_mistakes().
#pragma once

#include <vector>

#include "kernel/base/error.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

void check_cameras(const Scenario& scenario, std::vector<Diagnostic>& mistakes);
// Of topics and frames of all sensors: what is no name, and what is the name of another.
void check_sensor_names(const Scenario& scenario, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
