// The keys of the pile: what falls, the terrain below it, a building that collapses, and what comes when it rests.
#pragma once

#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

// The pile must outlive the schema.
void add_pile_keys(Schema& keys, PileScenario& pile);
void add_victim_keys(Schema& keys, VictimScenario& victims);
void add_fine_keys(Schema& keys, FinesSpec& fines);

// Adds what contradicts itself in fines whose keys are each in range.
void check_fines(const FinesSpec& fines, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
