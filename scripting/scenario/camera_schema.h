// The keys of the camera and its sensors.
#pragma once

#include "scripting/scenario/mission_form.h"
#include "scripting/schema/schema.h"

namespace rubble {

// The form must outlive the schema.
void add_camera_keys(Schema& keys, MissionForm& form);

}  // namespace rubble
