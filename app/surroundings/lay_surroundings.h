// What stands about a settled pile.
#pragma once

#include "app/assets/asset_library.h"
#include "kernel/model/pile_state.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Whether street lamps shine by themselves: at night, and when the sun is below the horizon.
bool is_dark(const Scenario& scenario);

// Puts what the scenario asks for about the pile; nothing where it asks for none. Follows from scenario, assets and
// pile alone.
void lay_surroundings(const Scenario& scenario, const AssetLibrary& assets, PileState& pile);

}  // namespace rubble
