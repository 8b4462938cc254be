// The functions by which a script reads files of its folder as data. Private to scripting.
#pragma once

#include "scripting/sandbox/lua_api.h"

namespace rubble {

// Puts read_table, read_image and read_trajectory into the table on top of the stack.
void add_file_functions(lua_State* lua);

}  // namespace rubble
