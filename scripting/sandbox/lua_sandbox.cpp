#include "scripting/sandbox/lua_sandbox.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/tables/text_table.h"
#include "kernel/base/text.h"
#include "scripting/sandbox/lua_host.h"
#include "scripting/sandbox/lua_library.h"
#include "scripting/sandbox/lua_value.h"
#include "scripting/sandbox/script_includes.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

constexpr int kHookEvery = 1000;  // instructions
constexpr std::uint64_t kInstructionsPerCall = 2'000'000;  // of a controller

double thread_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// "chunk0:12: " of the innermost function of a script, the prelude's left out; empty: none. Reads
// only what is there: it also runs where Lua has no memory left.
std::string position_of(lua_State* lua) {
  lua_Debug where{};
  for (int level = 0; lua_getstack(lua, level, &where) != 0; ++level) {
    lua_getinfo(lua, "Sl", &where);
    if (where.currentline > 0 && std::strncmp(where.short_src, "chunk", 5) == 0)
      return std::string(where.short_src) + ":" + std::to_string(where.currentline) + ": ";
  }
  return {};
}

// Lua's allocator: refuses to pass the limit, which Lua turns into "not enough memory".
void* allocate(void* user, void* block, std::size_t old_size, std::size_t new_size) {
  LuaHost& host = *static_cast<LuaHost*>(user);
  if (!block) old_size = 0;  // it then tells the kind of object
  if (new_size == 0) {
    std::free(block);
    host.memory -= old_size;
    return nullptr;
  }
  const std::size_t memory = host.memory - old_size + new_size;
  if (host.limited && new_size > old_size && memory > host.limits.memory) {
    host.refused_at = position_of(host.lua);
    return nullptr;
  }
  void* const moved = std::realloc(block, new_size);
  if (moved) host.memory = memory;
  return moved;
}

void count_instructions(lua_State* lua, lua_Debug*) { count_work(lua, kHookEvery); }

// Makes any error a string that begins with "chunkN:LINE: ".
int complete_message(lua_State* lua) {
  std::string text;
  if (lua_type(lua, 1) == LUA_TSTRING)
    text = lua_tostring(lua, 1);
  else
    text = std::string("an error that is a ") + luaL_typename(lua, 1) + ", not a message";
  // The library's own line helps nobody: the script's line that called it comes instead.
  if (text.rfind("prelude:", 0) == 0 || text.rfind("library ", 0) == 0)
    text.erase(0, text.find(": ") + 2);
  if (text.rfind("chunk", 0) != 0) text = position_of(lua) + text;
  return lua_pushlstring(lua, text.data(), text.size()), 1;
}

// Everything that a mission script may call below `rubble`, by its whole name.
std::vector<std::string> library_names() {
  std::vector<std::string> names{"controller", "include", "mission",    "options", "parameter", "random", "read_image",
                                 "read_table", "read_trajectory", "read_accelerogram", "read_calibration", "reject",
                                 "rotate", "vec"};
  for (const LibraryFile& file : lua_library()) names.push_back(file.name);
  for (std::string& name : names) {
    std::replace(name.begin(), name.end(), '/', '.');
    name = "rubble." + name;
  }
  return names;
}

// Of "attempt to call a nil value (field 'leanto')": the function that has nearly that name.
std::string find_near_function(const std::string& message) {
  const std::size_t field = message.find(" a nil value (field '");
  if (field == std::string::npos) return {};
  const std::size_t begin = message.find('\'', field) + 1;
  const std::string written = message.substr(begin, message.find('\'', begin) - begin);
  std::vector<std::string> last_words;
  const std::vector<std::string> names = library_names();
  for (const std::string& name : names) last_words.push_back(name.substr(name.rfind('.') + 1));
  const std::string near = nearest_name(written, last_words);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!near.empty() && last_words[i] == near) return names[i];
  return {};
}

std::string hint_for(const std::string& message) {
  static const char* const kClosed[] = {"os",           "io",           "require",   "dofile",
                                        "loadfile",     "package",      "load",      "debug",
                                        "setmetatable", "getmetatable", "coroutine", "pcall"};
  for (const char* name : kClosed)
    if (message.find(std::string("global '") + name + "'") != std::string::npos)
      return std::string("`") + name + "` is closed to scripts; docs/reference/missions.md lists what is open";
  if (message.find("binary chunk") != std::string::npos) return "only Lua source text is run";
  const std::string near = find_near_function(message);
  return near.empty() ? "" : "did you mean `" + near + "`?";
}

}  // namespace

void count_work(lua_State* lua, std::uint64_t instructions) {
  LuaHost& host = host_of(lua);
  if (!host.limited) return;
  host.instructions += instructions;
  const bool late = thread_cpu_seconds() - host.started > host.limits.seconds;
  if (host.instructions <= host.limits.instructions && !late) return;
  const std::string limit = late ? std::to_string(int(host.limits.seconds)) + " s"
                                 : std::to_string(host.limits.instructions) + " instructions";
  lua_pushfstring(lua, "the script does not end: stopped after %s", limit.c_str());
  lua_error(lua);
}

std::string_view lua_source(std::string_view text) {
  text = skip_byte_order_mark(text);
  if (!text.empty() && text[0] == '#')  // "#!/usr/bin/env ...": the line feed keeps the line numbers
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  return text;
}

struct LuaSandbox::State {
  LuaHost host;
  ScriptIncludes files;

  ~State() {
    host.limited = false;
    if (host.lua) lua_close(host.lua);
  }

  Diagnostic diagnostic_of(const std::string& raised) const;
  void call(int arguments, int results);  // throws InputError
  void load_library();
};

// "chunk0:12: text" -> the file's path, 12 and the text.
Diagnostic LuaSandbox::State::diagnostic_of(const std::string& raised) const {
  const std::vector<SourceFile>& chunks = files.chunks();
  const bool no_memory = raised == "not enough memory";
  const std::string message = no_memory ? host.refused_at + raised : raised;
  Diagnostic d;
  d.file = chunks.empty() ? "" : chunks[0].path;
  d.message = message;
  std::size_t chunk = 0;
  int line = 0, length = 0;
  if (std::sscanf(message.c_str(), "chunk%zu:%d: %n", &chunk, &line, &length) == 2 && length > 0 &&
      chunk < chunks.size()) {
    d.file = chunks[chunk].path;
    d.line = line;
    d.message = message.substr(std::size_t(length));
  }
  if (no_memory) {
    d.message = "the script needs too much memory";
    d.expected = "at most " + std::to_string(host.limits.memory >> 20) + " MiB";
  }
  d.hint = hint_for(d.message);
  return d;
}

// On the stack: the prelude's function install(name, value).
void LuaSandbox::State::load_library() {
  for (const LibraryFile& file : lua_library()) {
    lua_pushvalue(host.lua, -1);
    lua_pushlstring(host.lua, file.name.data(), file.name.size());
    const std::string& code = compiled_library().at(file.name);
    if (luaL_loadbufferx(host.lua, code.data(), code.size(), "", "b") != LUA_OK)
      throw RunError(lua_tostring(host.lua, -1));
    call(0, 1);
    call(2, 0);
  }
}

void LuaSandbox::State::call(int arguments, int results) {
  lua_State* const lua = host.lua;
  const int handler = lua_gettop(lua) - arguments;
  lua_pushcfunction(lua, complete_message);
  lua_insert(lua, handler);
  const int status = lua_pcall(lua, arguments, results, handler);
  if (status == LUA_OK) {
    lua_remove(lua, handler);
    return;
  }
  host.limited = false;
  const char* const text = lua_tostring(lua, -1);
  std::vector<Diagnostic> all = host.mistakes;  // which may be why it failed
  all.push_back(diagnostic_of(text ? text : "an error without a message"));
  throw InputError(std::move(all));
}

LuaSandbox::LuaSandbox(std::uint64_t seed, const std::string& entry, const SandboxLimits& limits)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.host.seed = seed;
  s.host.limits = limits;
  s.host.open_include = [&s](const std::string& name, std::string& error) {
    return s.files.open_text(name, error);
  };
  s.host.open_grid = [&s](const std::string& name, int side, std::string& error) {
    return s.files.open_grid(name, side, error);
  };
  s.host.chunk = [&s](int chunk) -> const SourceFile& { return s.files.chunks()[std::size_t(chunk)]; };
  s.host.limited = false;
  s.host.lua = lua_newstate(allocate, &s.host);
  if (!s.host.lua) throw RunError("no memory for a Lua state");
  *static_cast<LuaHost**>(lua_getextraspace(s.host.lua)) = &s.host;
  using Opener = std::pair<const char*, lua_CFunction>;
  for (const auto& [name, open] :
       {Opener{"_G", luaopen_base}, Opener{"string", luaopen_string},
        Opener{"table", luaopen_table}, Opener{"math", luaopen_math}}) {
    luaL_requiref(s.host.lua, name, open, 1);
    lua_pop(s.host.lua, 1);
  }
  if (luaL_loadbufferx(s.host.lua, kLuaPrelude, std::strlen(kLuaPrelude), "=prelude", "t") !=
      LUA_OK)
    throw RunError(std::string("prelude: ") + lua_tostring(s.host.lua, -1));
  push_host_functions(s.host.lua);
  lua_pushlstring(s.host.lua, entry.data(), entry.size());
  s.call(2, 1);
  if (entry == "rubble.mission") s.load_library();
  lua_settop(s.host.lua, 0);
}

LuaSandbox::~LuaSandbox() = default;

void LuaSandbox::serve_includes(std::map<std::string, std::string> texts) {
  state_->files.serve(std::move(texts));
}

void LuaSandbox::set_overrides(const std::vector<std::string>& overrides, std::vector<std::string> taken_names) {
  state_->host.taken_names = std::move(taken_names);
  for (const std::string& text : overrides) {
    const std::size_t equals = std::min(text.find('='), text.size());
    state_->host.overrides.push_back({text.substr(0, equals), text.substr(std::min(equals + 1, text.size()))});
  }
}

std::vector<std::pair<std::string, std::string>> LuaSandbox::unused_overrides() const {
  const LuaHost& host = state_->host;
  std::vector<std::string> names = host.options;
  std::string declared;
  for (const auto& [name, value] : host.parameters) {
    names.push_back(name);
    declared += (declared.empty() ? "the script declares " : ", ") + name;
  }
  std::vector<std::pair<std::string, std::string>> unused;
  for (const LuaHost::Override& o : host.overrides) {
    if (o.used) continue;
    const std::string near = nearest_name(o.name, names);
    unused.emplace_back(o.name + "=" + o.value, near.empty() ? declared : "did you mean `" + near + "`?");
  }
  return unused;
}

const std::map<std::string, std::string>& LuaSandbox::parameters() const { return state_->host.parameters; }

Value LuaSandbox::run(const std::string& text, const std::string& path) {
  State& s = *state_;
  s.files.begin(text, path);
  s.host.started = thread_cpu_seconds();
  s.host.limited = true;
  lua_sethook(s.host.lua, count_instructions, LUA_MASKCOUNT, kHookEvery);
  const std::string_view source = lua_source(text);
  if (luaL_loadbufferx(s.host.lua, source.data(), source.size(), chunk_name(0).c_str(), "t") !=
      LUA_OK) {
    s.host.limited = false;
    throw InputError(s.diagnostic_of(lua_tostring(s.host.lua, -1)));
  }
  s.call(0, 1);
  s.host.limited = false;  // reading the result is our work
  lua_sethook(s.host.lua, nullptr, 0, 0);
  Value value = read_lua_value(s.host.lua, -1);
  lua_settop(s.host.lua, 0);
  return value;
}

int LuaSandbox::controllers() const {
  lua_State* const lua = state_->host.lua;
  const bool any = lua_getfield(lua, LUA_REGISTRYINDEX, kControllers) == LUA_TTABLE;
  const int count = any ? int(lua_rawlen(lua, -1)) : 0;
  lua_settop(lua, 0);
  return count;
}

Value LuaSandbox::call_controller(int number, const Value& argument) {
  if (number < 1 || number > controllers())
    throw InputError({"", 0, "", "there is no function " + std::to_string(number), "one that rubble.controller registered", "", ""});
  State& s = *state_;
  lua_State* const lua = s.host.lua;
  const std::size_t mistakes = s.host.mistakes.size();
  lua_getfield(lua, LUA_REGISTRYINDEX, kControllers);
  lua_rawgeti(lua, -1, number);
  lua_remove(lua, -2);
  push_lua_value(lua, argument);
  s.host.instructions = 0;
  s.host.limits.instructions = kInstructionsPerCall;
  s.host.started = thread_cpu_seconds();
  s.host.limited = true;
  lua_sethook(lua, count_instructions, LUA_MASKCOUNT, kHookEvery);
  s.call(1, 1);
  s.host.limited = false;
  lua_sethook(lua, nullptr, 0, 0);
  Value value = read_lua_value(lua, -1);
  lua_settop(lua, 0);
  if (s.host.mistakes.size() > mistakes)
    throw InputError(std::vector<Diagnostic>(s.host.mistakes.begin() + std::ptrdiff_t(mistakes), s.host.mistakes.end()));
  return value;
}

const std::vector<Diagnostic>& LuaSandbox::mistakes() const { return state_->host.mistakes; }

std::vector<DescribedFunction> LuaSandbox::describe_library() {
  LuaSandbox sandbox(0, "rubble.mission");
  std::vector<DescribedFunction> all, described;
  // Called with nothing but what they cannot do without.
  std::string script = "local function one() return 1 end local function at() return {0, 0, 1} end\n";
  for (const LibraryFile& file : lua_library()) {
    const std::size_t slash = file.name.find('/');
    if (file.name == "find_void") script += "rubble.find_void {}\n";
    if (slash == std::string::npos || file.name == "density/image" ||
        file.name == "terrain/image")
      continue;
    const std::string first = file.name == "density/from" || file.name == "terrain/from"
                                  ? "one, "
                              : file.name == "trajectory/along" ? "at, "
                              : file.name == "trajectory/join"  ? "{ { position = { 0, 0, 1 } } }, "
                                                                : "";
    script += "rubble." + file.name.substr(0, slash) + "." + file.name.substr(slash + 1) + "(" +
              first + "{})\n";
  }
  sandbox.state_->host.described = &all;
  sandbox.run(script, "library");
  for (DescribedFunction& function : all) {
    const bool known = std::any_of(described.begin(), described.end(), [&](const auto& other) {
      return other.name == function.name;
    });
    if (!known) described.push_back(std::move(function));
  }
  return described;
}

bool LuaSandbox::used_random() const { return state_->host.used_random; }
const std::vector<std::pair<std::string, std::string>>& LuaSandbox::drawn() const {
  return state_->host.drawn;
}
const std::vector<SourceFile>& LuaSandbox::included() const { return state_->files.included(); }
std::vector<std::string> LuaSandbox::take_printed() {
  state_->host.printed_bytes = 0;
  return std::exchange(state_->host.printed, {});
}

}  // namespace rubble
