// The keys of a camera's real lens, and of what is not the same in all pixels of its sensor.
#pragma once

#include <string>
#include <vector>

#include "scripting/scenario/camera_scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

// at: what the keys begin with: "camera.", or nothing.
void add_optics_keys(Schema& keys, const std::string& at, OpticsSpec& optics);
void add_sensor_pattern_keys(Schema& keys, const std::string& at, ImageSensorSpec& sensor);
// What is wrong with both beyond ranges.
void check_optics(const CameraScenario& camera, const std::string& at, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
