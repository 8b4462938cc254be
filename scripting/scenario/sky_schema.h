// The keys of the sky, and of the sun by place and time.
#pragma once

#include <vector>

#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

void add_sky_keys(Schema& keys, LightScenario& light);
// What is wrong with them beyond ranges.
void check_sky(const LightScenario& light, std::vector<Diagnostic>& mistakes);
// Puts the sun where it is at the place and time that the mission states, if it does.
void place_sun(const LightScenario& light, LightSpec& spec);

}  // namespace rubble
