// A complete scenario as a mission script that gives the same scenario again, to the last bit.
#pragma once

#include <string>

#include "app/assets/asset_library.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// comment: printed at the top, as lines of a Lua comment.
std::string scenario_to_lua(const Scenario& scenario, const std::string& comment);

// The scenario with the whole paths of its terrain, snapshot and robots' files, and of its packs where it names some or
// `packs` is true. assets: of the mission.
Scenario with_whole_paths(Scenario scenario, const AssetLibrary& assets, bool packs = false);

}  // namespace rubble
