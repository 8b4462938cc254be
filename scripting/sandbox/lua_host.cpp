#include "scripting/sandbox/lua_host.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <new>
#include <type_traits>

#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/base/text.h"
#include "scripting/sandbox/lua_options.h"
#include "scripting/sandbox/lua_value.h"
#include "scripting/values/value.h"

// Lua's C++ build reports errors by an exception, so the destructors below run.

namespace rubble {
namespace {

constexpr const char* kStreamType = "random stream";
constexpr std::size_t kMostPrinted = 1 << 20;  // unit: byte
constexpr std::uint64_t kInstructionsPerValue = 50;  // that cost as much as to read it
constexpr std::size_t kMostMistakes = 1000;    // that rubble.options keeps
constexpr int kMostDrawsOfStream = 8;          // that are noted by name
constexpr std::size_t kMostDraws = 64;

RandomStream& stream_at(lua_State* lua, int index) {
  host_of(lua).used_random = true;
  return *static_cast<RandomStream*>(luaL_checkudata(lua, index, kStreamType));
}

double finite_at(lua_State* lua, int index) {
  const double value = luaL_checknumber(lua, index);
  luaL_argcheck(lua, std::isfinite(value), index, "a finite number expected");
  return value;
}

// unit: whatever the caller's; portable functions are exact only within their stated ranges.
double limited_at(lua_State* lua, int index, double limit) {
  const double value = finite_at(lua, index);
  luaL_argcheck(lua, std::abs(value) <= limit, index, "number too large");
  return value;
}

int make_stream(lua_State* lua) {
  static_assert(std::is_trivially_destructible_v<RandomStream>, "no __gc is needed");
  const std::string name = text_argument(lua, 1);
  void* const memory = lua_newuserdatauv(lua, sizeof(RandomStream), 1);
  new (memory) RandomStream(host_of(lua).seed, "lua/" + name);
  luaL_setmetatable(lua, kStreamType);
  lua_pushvalue(lua, 1);  // its name, for note_draw
  lua_setiuservalue(lua, -2, 1);
  return 1;
}

// The name under which the next value of the stream at index 1 is noted; empty: it is not.
std::string next_draw_name(lua_State* lua) {
  LuaHost& host = host_of(lua);
  if (host.drawn.size() >= kMostDraws) return "";
  lua_getiuservalue(lua, 1, 1);
  std::string name = lua_tostring(lua, -1);
  lua_pop(lua, 1);
  int& count = host.draws[name];
  if (count >= kMostDrawsOfStream) return "";
  return ++count == 1 ? name : name + "." + std::to_string(count);
}

void note_draw(lua_State* lua, const std::string& name, std::string value) {
  if (!name.empty()) host_of(lua).drawn.emplace_back(name, std::move(value));
}

int draw_uniform(lua_State* lua) {
  RandomStream& random = stream_at(lua, 1);
  const double low = lua_isnoneornil(lua, 2) ? 0.0 : finite_at(lua, 2);
  const double high = lua_isnoneornil(lua, 3) ? 1.0 : finite_at(lua, 3);
  luaL_argcheck(lua, low <= high, 3, "the upper limit is below the lower one");
  luaL_argcheck(lua, std::isfinite(high - low), 3, "the range is too wide");
  const double value = random.uniform(low, high);
  note_draw(lua, next_draw_name(lua), exact_text(value));
  lua_pushnumber(lua, value);
  return 1;
}

int draw_integer(lua_State* lua) {
  RandomStream& random = stream_at(lua, 1);
  const lua_Integer low = luaL_checkinteger(lua, 2), high = luaL_checkinteger(lua, 3);
  luaL_argcheck(lua, low <= high, 3, "the upper limit is below the lower one");
  const std::uint64_t count = std::uint64_t(high) - std::uint64_t(low) + 1;  // 0: all of 2^64
  const std::uint64_t offset = count == 0 ? random.next() : random.below(count);
  const auto value = static_cast<lua_Integer>(std::uint64_t(low) + offset);
  note_draw(lua, next_draw_name(lua), std::to_string(value));
  lua_pushinteger(lua, value);
  return 1;
}

int draw_normal(lua_State* lua) {
  RandomStream& random = stream_at(lua, 1);
  const double mean = lua_isnoneornil(lua, 2) ? 0.0 : finite_at(lua, 2);
  const double deviation = lua_isnoneornil(lua, 3) ? 1.0 : finite_at(lua, 3);
  const double value = mean + deviation * random.normal();
  note_draw(lua, next_draw_name(lua), exact_text(value));
  lua_pushnumber(lua, value);
  return 1;
}

int draw_choice(lua_State* lua) {
  RandomStream& random = stream_at(lua, 1);
  luaL_checktype(lua, 2, LUA_TTABLE);
  const lua_Unsigned count = lua_rawlen(lua, 2);
  luaL_argcheck(lua, count > 0, 2, "an empty list");
  const auto chosen = static_cast<lua_Integer>(random.below(count)) + 1;
  const int type = lua_rawgeti(lua, 2, chosen);
  std::string text = std::to_string(chosen);
  if (type == LUA_TSTRING) text = lua_tostring(lua, -1);
  if (type == LUA_TNUMBER) text = exact_text(lua_tonumber(lua, -1));
  note_draw(lua, next_draw_name(lua), printable(text));
  return 1;
}

int draw_direction(lua_State* lua) {
  const Vec3 v = stream_at(lua, 1).direction();
  const std::string name = next_draw_name(lua);
  for (int i = 0; i < 3 && !name.empty(); ++i)
    note_draw(lua, name + "." + "xyz"[i], exact_text(v[i]));
  lua_createtable(lua, 3, 0);
  for (int i = 0; i < 3; ++i) {
    lua_pushnumber(lua, v[i]);
    lua_rawseti(lua, -2, i + 1);
  }
  return 1;
}

int print_line(lua_State* lua) {
  std::size_t size = 0;
  const char* const text = luaL_checklstring(lua, 1, &size);
  LuaHost& host = host_of(lua);
  host.printed_bytes += size + 1;
  if (host.printed_bytes > kMostPrinted)
    return luaL_error(lua, "the script prints more than 1 MiB");
  host.printed.push_back(printable({text, size}));
  return 0;
}

// controller(function) -> its number. What drives robots is called long after the script has ended.
int keep_controller(lua_State* lua) {
  constexpr lua_Unsigned kMost = 1000;
  luaL_checktype(lua, 1, LUA_TFUNCTION);
  if (lua_getfield(lua, LUA_REGISTRYINDEX, kControllers) != LUA_TTABLE) {
    lua_pop(lua, 1);
    lua_newtable(lua);
    lua_pushvalue(lua, -1);
    lua_setfield(lua, LUA_REGISTRYINDEX, kControllers);
  }
  const lua_Unsigned number = lua_rawlen(lua, -1) + 1;
  if (number > kMost) return luaL_error(lua, "rubble.controller: more than 1000 functions");
  lua_pushvalue(lua, 1);
  lua_rawseti(lua, -2, lua_Integer(number));
  return lua_pushinteger(lua, lua_Integer(number)), 1;
}

int include_file(lua_State* lua) {
  const std::string name = text_argument(lua, 1);
  LuaHost& host = host_of(lua);
  std::string error;
  const int chunk = host.open_include(name, error);
  if (chunk < 0) return luaL_error(lua, "rubble.include: %s", error.c_str());
  const std::string_view text = lua_source(host.chunk(chunk).text);
  if (luaL_loadbufferx(lua, text.data(), text.size(), chunk_name(chunk).c_str(), "t") != LUA_OK)
    return lua_error(lua);
  lua_call(lua, 0, 1);
  return 1;
}

// The script's line from which the function that asked for its options was called.
bool find_caller(lua_State* lua, int& chunk, int& line) {
  lua_Debug where{};
  for (int level = 2; lua_getstack(lua, level, &where) != 0; ++level) {
    lua_getinfo(lua, "Sl", &where);
    line = where.currentline;
    if (line > 0 && std::sscanf(where.short_src, "chunk%d", &chunk) == 1) return true;
  }
  return false;
}

void note_mistakes(lua_State* lua, const std::string& function, std::vector<Diagnostic> mistakes) {
  LuaHost& host = host_of(lua);
  int chunk = 0, call_line = 0;
  const bool found = find_caller(lua, chunk, call_line);
  const SourceFile& source = host.chunk(found ? chunk : 0);
  if (host.mistakes.size() + mistakes.size() > kMostMistakes)
    luaL_error(lua, "%s: too many mistakes", function.c_str());
  if (mistakes.empty()) return;
  const auto known = host.tokens.find(found ? chunk : 0);
  const std::vector<LuaToken>& tokens =
      known != host.tokens.end() ? known->second
                                 : host.tokens[found ? chunk : 0] = read_lua_tokens(source.text);
  count_work(lua, tokens.size() * mistakes.size());
  for (Diagnostic& d : mistakes) {
    const std::string key = d.key.substr(std::min(d.key.size(), function.size() + 1));
    d.file = source.path;
    d.line = find_option_line(tokens, function, key, found ? call_line : 0);
    host.mistakes.push_back(std::move(d));
  }
}

// Values from outside, instead of those of the script. prefix: of their names, "rubble.wall." or nothing.
void apply_overrides(LuaHost& host, const std::string& prefix, const Schema& schema) {
  for (LuaHost::Override& o : host.overrides) {
    if (o.name.rfind(prefix, 0) != 0) continue;
    const std::string key = o.name.substr(prefix.size());
    if (prefix.empty() && !schema.find(key)) continue;
    std::vector<Diagnostic> mistakes;
    apply_override(schema, key + "=" + o.value, mistakes);
    for (Diagnostic& d : mistakes) {
      d.key = prefix + d.key;
      if (!o.used) host.mistakes.push_back(std::move(d));
    }
    o.used = true;
  }
}

// parameter(name, {name, default, ...}) -> its value: the default, or what was given from outside.
int read_parameter(lua_State* lua) {
  const std::string name = text_argument(lua, 1);
  const auto is_word = [](char c) { return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (name.empty() || name.size() > 64 || !std::all_of(name.begin(), name.end(), is_word) || (name[0] >= '0' && name[0] <= '9'))
    return luaL_error(lua, "rubble.parameter: a name is a word of letters, digits and _, not \"%s\"", printable(name).c_str());
  LuaHost& host = host_of(lua);
  if (std::find(host.taken_names.begin(), host.taken_names.end(), name) != host.taken_names.end())
    return luaL_error(lua, "rubble.parameter: \"%s\" is a key of the mission: give the parameter another name", name.c_str());
  Value description = Value::make_table();
  description.items.push_back(read_lua_value(lua, 2));
  std::string failure;
  try {
    OptionTable table(description);
    apply_overrides(host, "", table.schema());
    const Value values = table.values();
    const Value* const value = values.find(name);
    host.parameters[name] = value ? describe(*value) : "nil";
    if (value)
      push_lua_value(lua, *value);
    else
      lua_pushnil(lua);
  } catch (const InputError& error) {
    failure = error.diagnostics().front().text();
    for (const char* const word : {"rubble.options: entry 1 ", "rubble.options"}) {
      const std::size_t at = failure.find(word);
      if (at != std::string::npos) failure.replace(at, std::string(word).size(), "rubble.parameter ");
    }
  }
  return failure.empty() ? 1 : luaL_error(lua, "%s", failure.c_str());
}

// options(function, given, description) -> every parameter, given or default. Mistakes are noted,
// not raised: all of them come in one run.
int read_options(lua_State* lua) {
  const std::string function = text_argument(lua, 1);
  std::size_t values = 0;
  const Value given = read_lua_value(lua, 2, &values), description = read_lua_value(lua, 3, &values);
  count_work(lua, kInstructionsPerValue * values);
  LuaHost& host = host_of(lua);
  if (host.described) host.described->push_back({function, description});
  std::string failure;
  try {
    OptionTable table(description);
    note_mistakes(lua, function, table.read(function, given));
    if (!host.overrides.empty()) {
      for (const Key& key : table.schema().keys())
        if (key.kind == KeyKind::value) host.options.push_back(function + "." + key.path);
      apply_overrides(host, function + ".", table.schema());
    }
    push_lua_value(lua, table.values());
  } catch (const InputError& error) {
    failure = error.diagnostics().front().text();
  }
  return failure.empty() ? 1 : luaL_error(lua, "%s", failure.c_str());
}

// reject(function, parameter, expected, found): a mistake that only the function itself can see.
int reject_option(lua_State* lua) {
  const std::string function = text_argument(lua, 1);
  Diagnostic d;
  d.key = function + "." + text_argument(lua, 2);
  d.message = lua_isnoneornil(lua, 4) ? "missing" : "out of range";
  d.expected = text_argument(lua, 3);
  d.found = describe(read_lua_value(lua, 4));
  note_mistakes(lua, function, {d});
  return 0;
}

// rotate({roll, pitch, yaw} in degrees, {x, y, z}) -> {x, y, z}
int rotate_vector(lua_State* lua) {
  const auto numbers_at = [lua](int index) {
    luaL_checktype(lua, index, LUA_TTABLE);
    static const char* const kNames[] = {"x", "y", "z"};
    Vec3 v;
    for (int i = 0; i < 3; ++i) {
      if (lua_getfield(lua, index, kNames[i]) == LUA_TNIL) lua_rawgeti(lua, index, i + 1);
      luaL_argcheck(lua, lua_isnumber(lua, -1), index, "three numbers {x, y, z} expected");
      v[i] = lua_tonumber(lua, -1);
      luaL_argcheck(lua, std::isfinite(v[i]), index, "three finite numbers {x, y, z} expected");
      luaL_argcheck(lua, std::abs(v[i]) <= 1e6, index, "number too large");
    }
    return v;
  };
  const Vec3 rpy = numbers_at(1) * (portable::kPi / 180), v = numbers_at(2);
  const Vec3 turned = portable::quat_from_rpy(rpy.x, rpy.y, rpy.z).rotate(v);
  for (int i = 0; i < 3; ++i) lua_pushnumber(lua, turned[i]);
  return 3;
}

int math_sin(lua_State* lua) {
  return lua_pushnumber(lua, portable::sin(limited_at(lua, 1, 1e6))), 1;
}
int math_cos(lua_State* lua) {
  return lua_pushnumber(lua, portable::cos(limited_at(lua, 1, 1e6))), 1;
}
int math_tan(lua_State* lua) {
  const portable::SinCos sc = portable::sincos(limited_at(lua, 1, 1e6));
  return lua_pushnumber(lua, sc.sin / sc.cos), 1;
}
int math_asin(lua_State* lua) {
  return lua_pushnumber(lua, portable::asin(limited_at(lua, 1, 1))), 1;
}
int math_acos(lua_State* lua) {
  return lua_pushnumber(lua, portable::acos(limited_at(lua, 1, 1))), 1;
}
int math_atan(lua_State* lua) {
  const double y = finite_at(lua, 1), x = lua_isnoneornil(lua, 2) ? 1.0 : finite_at(lua, 2);
  return lua_pushnumber(lua, portable::atan2(y, x)), 1;
}
int math_exp(lua_State* lua) {
  return lua_pushnumber(lua, portable::exp(limited_at(lua, 1, 700))), 1;
}
int math_log(lua_State* lua) {
  const auto positive_at = [lua](int index) {
    const double x = finite_at(lua, index);
    luaL_argcheck(lua, std::isnormal(x) && x > 0, index, "a number above 0 expected");
    return x;
  };
  const double value = portable::log(positive_at(1));
  const double base = lua_isnoneornil(lua, 2) ? 1.0 : portable::log(positive_at(2));
  return lua_pushnumber(lua, value / base), 1;
}

const luaL_Reg kFunctions[] = {
    {"options", read_options}, {"parameter", read_parameter}, {"reject", reject_option}, {"rotate", rotate_vector}, {"stream", make_stream}, {"controller", keep_controller}, {"print", print_line}, {"include", include_file}, {"sin", math_sin},
    {"cos", math_cos},       {"tan", math_tan},     {"asin", math_asin},       {"acos", math_acos},
    {"atan", math_atan},     {"exp", math_exp},     {"log", math_log},         {nullptr, nullptr}};

const luaL_Reg kStreamMethods[] = {{"uniform", draw_uniform},     {"integer", draw_integer},
                                   {"normal", draw_normal},       {"choice", draw_choice},
                                   {"direction", draw_direction}, {nullptr, nullptr}};

}  // namespace

LuaHost& host_of(lua_State* lua) { return **static_cast<LuaHost**>(lua_getextraspace(lua)); }

std::string chunk_name(int chunk) { return "=chunk" + std::to_string(chunk); }

void push_host_functions(lua_State* lua) {
  luaL_newmetatable(lua, kStreamType);
  luaL_newlib(lua, kStreamMethods);
  lua_setfield(lua, -2, "__index");
  lua_pop(lua, 1);
  luaL_newlib(lua, kFunctions);
  add_file_functions(lua);
}

}  // namespace rubble
