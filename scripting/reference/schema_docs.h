// What people and editors read about the keys, made from the schemas.
#pragma once

#include <string>
#include <vector>

namespace rubble {

// JSON Schema (draft 2020-12) of a mission: of what `rubble check` prints and of what a script
// returns, the published simulator's names included.
std::string mission_json_schema();

// The paths that --set takes, but for items of lists, and the published names; in order.
std::vector<std::string> mission_keys();

// What editors check and complete missions, packs and suites by: LuaCATS annotations of every key and
// function, as one Lua file that is never run.
std::string lua_annotations();

// Tables in Markdown: every key of a mission, its type, range, default and meaning; then the
// published names; then the keys of pack.lua.
std::string lua_reference();

// The text with what stands between its two marker lines replaced by lua_reference(). Throws
// std::runtime_error when a marker is missing.
std::string with_reference(const std::string& document);

// The functions of the closed environment that are written in C++ or in the prelude, annotated by hand;
// a test compares their names with those that a script sees.
extern const char* const kLuaBaseAnnotations;

}  // namespace rubble
