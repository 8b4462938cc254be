// From a value on Lua's stack to plain data and back. Private to scripting.
#pragma once

#include <string>

#include "scripting/sandbox/lua_api.h"
#include "scripting/values/value.h"

namespace rubble {

// Reads without calling anything of the script's. Deeper than 16 tables (or in a circle), beyond a
// million values or 16 MiB of strings (one string may stand in many places), and for a string that
// is not UTF-8 or has a zero byte, "other" stands in. count: the values read are added to it; null: not asked for.
Value read_lua_value(lua_State* lua, int index, std::size_t* count = nullptr);

// The string at `index` among a function's arguments, or of the number there; an error of Lua if it is neither, or has
// a zero byte.
std::string text_argument(lua_State* lua, int index);

// Pushes it. A value that is no plain data is an error of Lua.
void push_lua_value(lua_State* lua, const Value& value);

// The functions by which a script reads files of its folder as data. Private to scripting.
// Puts read_table, read_image and read_trajectory into the table on top of the stack.
void add_file_functions(lua_State* lua);

}  // namespace rubble
