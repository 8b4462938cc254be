// A mission as users write it, with forms that are convenient for them. All that comes after the loader has the lists of
// Scenario alone.
#pragma once

#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

struct MissionForm {
  Scenario rest;         // of its lists, what the tables `cameras`, `imus` and `lights` hold
  MountedCamera camera;  // `camera`, `depth_sensor`, `event_camera`
  bool imu_on = false;   // without it, what `imu` says is without effect
  ImuScenario imu;
  LightScenario light;   // the main light

  explicit MissionForm(const Scenario& scenario = {});
  Scenario normalized() const;
};

// The mistakes of a mission, with those that a Scenario cannot have: both forms of the same.
std::vector<Diagnostic> find_mistakes(const MissionForm& form);

// The keys of a mission, in the order of the reference.
// The form must outlive the schema.
Schema make_scenario_schema(MissionForm& form);

}  // namespace rubble
