// Files that a mission names, for a copy of it that is saved elsewhere.
#pragma once

#include "app/assets/asset_library.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// The scenario with the whole paths of its terrain, snapshot and robots' files, and of its packs where it names some or
// `packs` is true. assets: of the mission.
Scenario with_whole_paths(Scenario scenario, const AssetLibrary& assets, bool packs = false);

}  // namespace rubble
