// The part of the library of scripts that is written in Lua itself: the files of scripting/lua,
// compiled in. They run in the closed environment, with the same functions as any script has.
#pragma once

#include <string>
#include <vector>

namespace rubble {

struct LibraryFile {
  std::string name;  // "collapse/lean_to": what its chunk returns becomes rubble.collapse.lean_to
  std::string text;  // of the Lua file
};

const std::vector<LibraryFile>& lua_library();  // in the order to be run

}  // namespace rubble
