// What people and editors read about the keys, made from the schemas.
#pragma once

#include <string>

namespace rubble {

// JSON Schema (draft 2020-12) of a mission: of what `rubble check` prints and of what a script
// returns, the published simulator's names included.
std::string mission_json_schema();

// Tables in Markdown: every key of a mission, its type, range, default and meaning; then the
// published names; then the keys of pack.lua.
std::string lua_reference();

// The text with what stands between its two marker lines replaced by lua_reference(). Throws
// std::runtime_error when a marker is missing.
std::string with_reference(const std::string& document);

}  // namespace rubble
