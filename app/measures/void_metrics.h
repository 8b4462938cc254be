// The voids of a settled pile as figures, for missions that ask for them (`voids.on`).
#pragma once

#include <functional>

#include "app/assets/asset_library.h"
#include "app/measures/metrics.h"
#include "kernel/model/pile_state.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// done: 0 to 1. Return false to stop; RunError is thrown then. Throws InputError naming
// `voids.voxel` when the memory would not do.
void add_void_metrics(const VoidScenario& voids, const PileState& pile, const AssetLibrary& assets,
                      int threads, const std::function<bool(double done)>& progress,
                      Metrics& metrics);

}  // namespace rubble
