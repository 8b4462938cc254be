// The files of lua_library(), compiled once a process: that is most of what a small script costs.
#pragma once

#include <map>
#include <string>

namespace rubble {

// Lua's code of each file, by its name, with the names and lines that errors need. Throws RunError
// for a file that does not compile.
const std::map<std::string, std::string>& compiled_library();

}  // namespace rubble
