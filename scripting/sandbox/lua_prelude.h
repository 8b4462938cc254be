// The Lua side of the sandbox: what a script finds in its globals.
#pragma once

namespace rubble {

// A chunk that takes the table of host functions (lua_host.cpp) and the name of the entry function,
// builds the script's globals from the standard libraries and closes everything else.
extern const char* const kLuaPrelude;

}  // namespace rubble
