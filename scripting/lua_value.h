// From a value on Lua's stack to plain data and back. Private to scripting.
#pragma once

#include <lua.hpp>

#include "scripting/value.h"

namespace rubble {

// Reads without calling anything of the script's. Deeper than 16 tables (or in a circle) and beyond
// a million values, "other" stands in.
Value read_lua_value(lua_State* lua, int index);

// Pushes it. A value that is no plain data is an error of Lua.
void push_lua_value(lua_State* lua, const Value& value);

}  // namespace rubble
