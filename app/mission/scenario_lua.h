// A complete scenario as a mission script that gives the same scenario again, to the last bit.
#pragma once

#include <string>

#include "scripting/scenario/scenario.h"

namespace rubble {

// comment: printed at the top, as lines of a Lua comment.
std::string scenario_to_lua(const Scenario& scenario, const std::string& comment);

}  // namespace rubble
