// The keys of a mission, in the order of the reference.
#pragma once

#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

// The scenario must outlive the schema.
Schema make_scenario_schema(Scenario& scenario);

}  // namespace rubble
