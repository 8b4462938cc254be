// What a mission says of the pile, where `rubble render` keeps the pile of another run.
#pragma once

#include <string>
#include <vector>

#include "scripting/scenario/scenario.h"

namespace rubble {

// stated: as the mission and `overrides` ("key=value") say it; kept: with the pile of `run`, a folder. Returns a warning that
// names what the mission asks for in vain, or an empty text. What has its default is not asked for. Throws InputError where
// an override asks in vain.
std::string describe_kept_pile(const Scenario& stated, const Scenario& kept, const std::vector<std::string>& overrides,
                               const std::string& run);

}  // namespace rubble
