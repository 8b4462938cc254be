// Steps that mission and pack scripts share. Private to scripting.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/sandbox/source_map.h"

namespace rubble {

inline constexpr std::size_t kLargestScript = std::size_t(4) << 20;  // unit: byte

// Throws InputError when the file cannot be read, is larger than that or is not UTF-8.
SourceFile read_script(const std::string& path);

// Throws InputError with the line of the first byte that is no UTF-8: manifests keep scripts as text.
void check_utf8(const std::string& text, const std::string& path);

// Runs it. Where Lua has lost the line (a call in `return f(...)`), errors name that `return`.
Value run_script(LuaSandbox& sandbox, const SourceFile& script, const SourceMap& lines);

// Gives each mistake that has no file yet the script's path and the line of its key.
void locate(std::vector<Diagnostic>& mistakes, const std::string& path, const SourceMap& lines);

// Adds one for each key written twice in one table.
void add_duplicates(const SourceMap& lines, std::vector<Diagnostic>& mistakes);

// Adds the found ones unless their top-level section has a mistake already, from which they may
// only follow.
void add_unrelated(const std::vector<Diagnostic>& found, std::vector<Diagnostic>& mistakes);

// Throws them, by file in order of first appearance, then by line; nothing when there are none.
void throw_if_any(std::vector<Diagnostic> mistakes);

}  // namespace rubble
