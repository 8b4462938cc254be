// The keys of the parts of a mission, and what is wrong with their values beyond ranges. For scenario_schema.cpp and
// scenario.cpp. What a function adds keys for must outlive the schema.
#pragma once

#include <string>
#include <vector>

#include "scripting/scenario/camera_scenario.h"
#include "scripting/scenario/mission_form.h"
#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

void add_camera_keys(Schema& keys, MissionForm& form);

// at: what the keys begin with: "camera.", or nothing.
void add_optics_keys(Schema& keys, const std::string& at, OpticsSpec& optics);
void add_sensor_pattern_keys(Schema& keys, const std::string& at, ImageSensorSpec& sensor);
// What is wrong with both beyond ranges.
void check_optics(const CameraScenario& camera, const std::string& at, std::vector<Diagnostic>& mistakes);

void add_pile_keys(Schema& keys, PileScenario& pile);
void add_victim_keys(Schema& keys, VictimScenario& victims);
void add_fine_keys(Schema& keys, FinesSpec& fines);

// Adds what contradicts itself in fines whose keys are each in range.
void check_fines(const FinesSpec& fines, std::vector<Diagnostic>& mistakes);

void add_light_keys(Schema& keys, MissionForm& form);  // of lamp and air, too

void add_sky_keys(Schema& keys, LightScenario& light);
// What is wrong with them beyond ranges.
void check_sky(const LightScenario& light, std::vector<Diagnostic>& mistakes);
// Puts the sun where it is at the place and time that the mission states, if it does.
void place_sun(const LightScenario& light, LightSpec& spec);

void add_surroundings_keys(Schema& keys, SurroundingsSpec& surroundings);
// What is wrong with them beyond ranges.
void check_surroundings(const Scenario& scenario, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
