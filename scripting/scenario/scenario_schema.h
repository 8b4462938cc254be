// The keys of a mission, in the order of the reference.
#pragma once

#include "scripting/scenario/mission_form.h"
#include "scripting/schema/schema.h"

namespace rubble {

// The form must outlive the schema.
Schema make_scenario_schema(MissionForm& form);

}  // namespace rubble
