// The keys of the camera and its sensors.
#pragma once

#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

// The scenario must outlive the schema.
void add_camera_keys(Schema& keys, Scenario& scenario);

}  // namespace rubble
