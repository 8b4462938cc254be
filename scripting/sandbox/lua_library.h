// The part of the library of scripts that is written in Lua itself: the files of scripting/lua,
// compiled in. They run in the closed environment, with the same functions as any script has.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace rubble {

struct LibraryFile {
  std::string name;  // "collapse/lean_to": what its chunk returns becomes rubble.collapse.lean_to
  std::string text;  // of the Lua file
};

const std::vector<LibraryFile>& lua_library();  // in the order to be run

// The files of lua_library(), compiled once a process: that is most of what a small script costs.
// Lua's code of each file, by its name, with the names and lines that errors need. Throws RunError
// for a file that does not compile.
const std::map<std::string, std::string>& compiled_library();

// The Lua side of the sandbox: what a script finds in its globals.
// A chunk that takes the table of host functions (lua_host.cpp) and the name of the entry function,
// builds the script's globals from the standard libraries and closes everything else.
extern const char* const kLuaPrelude;

}  // namespace rubble
