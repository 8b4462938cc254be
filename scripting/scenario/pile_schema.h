// The keys of the pile: what falls, the terrain below it, and a building that collapses.
#pragma once

#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

// The pile must outlive the schema.
void add_pile_keys(Schema& keys, PileScenario& pile);
void add_victim_keys(Schema& keys, VictimScenario& victims);

}  // namespace rubble
