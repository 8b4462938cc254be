// The keys of what stands about the pile.
#pragma once

#include <vector>

#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

void add_surroundings_keys(Schema& keys, SurroundingsSpec& surroundings);
// What is wrong with them beyond ranges.
void check_surroundings(const Scenario& scenario, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
