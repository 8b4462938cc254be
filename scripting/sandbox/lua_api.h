// The functions of Lua. Debian's C++ build of Lua has the names of C in Debian 12 and those of C++ in Debian 13; CMake
// finds out which (RUBBLE_LUA_CXX_NAMES).
#pragma once

#ifdef RUBBLE_LUA_CXX_NAMES
#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>
#else
#include <lua.hpp>
#endif
