// The voids of a settled pile as figures, for missions that ask for them (`voids.on`).
#pragma once

#include "app/measures/metrics.h"
#include "kernel/voids/void_map.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// What the mission asks of the map of voids.
VoidSpaceOptions make_void_options(const VoidScenario& voids);

// map: with the voids of a robot of that radius (unit: m).
void add_void_metrics(const VoidMap& map, double radius, Metrics& metrics);

}  // namespace rubble
