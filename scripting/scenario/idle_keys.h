// Keys that a mission states though nothing reads them: the intensity of a light of type `sun`, say, or the cone of a lamp
// that is off. They are allowed, and hardly meant.
#pragma once

#include <string>
#include <vector>

#include "scripting/scenario/mission_form.h"

namespace rubble {

struct StatedKeys {
  // Whole paths: "cameras.left.exposure.time". Not the names of the published simulator: its lists of parameters state all.
  std::vector<std::string> in_script;
  std::vector<std::string> by_set;     // likewise, of --set
};

// One diagnostic for each such key, without file and line; of --set with "--set" as the file. Tables that are switched off on
// purpose, by a switch that the mission states, may say what they like: a script is written for both.
std::vector<Diagnostic> find_idle_keys(const MissionForm& form, const StatedKeys& stated);

}  // namespace rubble
