// The C++ side of the sandbox: functions that the prelude gives to scripts. Private to scripting.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "kernel/base/error.h"
#include "scripting/sandbox/lua_api.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/sandbox/lua_tokens.h"

namespace rubble {

// What the functions need; a pointer to it lives in the Lua state's extra space.
struct LuaHost {
  lua_State* lua = nullptr;                                // owned by LuaSandbox
  std::uint64_t seed = 0;                                  // of rubble.random
  bool used_random = false;                                // whether the script has drawn a number
  std::vector<std::pair<std::string, std::string>> drawn;  // see LuaSandbox::drawn
  std::map<std::string, int> draws;                        // of each stream, as far as counted
  std::size_t printed_bytes = 0;                           // of all of `printed`
  std::vector<std::string> printed;                        // lines, made printable
  // Reads a file for rubble.include and returns its index among the chunks; on failure it puts the
  // reason into `error` and returns -1.
  std::function<int(const std::string& name, std::string& error)> open_include;
  // Likewise a picture or an elevation model, kept as text (scripting/files/data_grid.h) with at most `side`
  // points a side.
  std::function<int(const std::string& name, int side, std::string& error)> open_grid;
  std::function<const SourceFile&(int chunk)> chunk;

  // Values from outside for parameters of the script and options of functions, by name; used: some took it.
  struct Override {
    std::string name, value;
    bool used = false;
  };
  std::vector<Override> overrides;
  std::vector<std::string> taken_names;                  // no parameter may have: those of the mission's keys
  std::map<std::string, std::string> parameters;         // that the script declared, with their values as text
  std::vector<std::string> options;                      // every "FUNCTION.OPTION" that a function asked for

  // What rubble.options found, and, while the reference is made, what it was asked for.
  std::vector<Diagnostic> mistakes;
  std::vector<DescribedFunction>* described = nullptr;  // null: no reference is made
  std::map<int, std::vector<LuaToken>> tokens;          // of chunks in which mistakes were found

  // Limits, and what has been used of them.
  SandboxLimits limits;
  std::size_t memory = 0;          // that the script holds now; unit: byte
  std::uint64_t instructions = 0;  // that it has run so far
  std::string refused_at;          // "chunk0:12: " where memory was refused last
  double started = 0;              // CPU seconds of this thread
  bool limited = true;             // false once the script has ended and only its table is read
};

LuaHost& host_of(lua_State* lua);

// Counts work that a function of ours does for a script as if it were so many instructions. An error
// of Lua when a limit is reached.
void count_work(lua_State* lua, std::uint64_t instructions);

// What Lua shall read of a file: all but a byte order mark and a first line that begins with `#`.
std::string_view lua_source(std::string_view text);

// Where the registry keeps the functions that rubble.controller was given.
inline constexpr const char* kControllers = "controllers";

// Lua names a chunk in its messages; ours are "chunk0", "chunk1", ... and stand for paths.
std::string chunk_name(int chunk);

// Leaves a table with every host function on the stack.
void push_host_functions(lua_State* lua);

}  // namespace rubble
