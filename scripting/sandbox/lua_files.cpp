#include "scripting/sandbox/lua_value.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kernel/base/portable_math.h"
#include "kernel/base/tables/text_table.h"
#include "kernel/base/text.h"
#include "scripting/files/accelerogram.h"
#include "scripting/files/calibration.h"
#include "scripting/files/data_grid.h"
#include "scripting/sandbox/lua_host.h"
#include "scripting/trajectory/trajectory_text.h"
#include "scripting/values/value.h"

// Lua's C++ build reports errors by an exception, so the destructors below run.

namespace rubble {
namespace {

constexpr std::uint64_t kInstructionsPerWord = 20;  // that cost as much as to read it

// The text of a file of the script's folder; an error of Lua that names `function` otherwise.
const std::string& text_of(lua_State* lua, const char* function, const std::string& name) {
  std::string error;
  const int chunk = host_of(lua).open_include(name, error);
  if (chunk < 0) luaL_error(lua, "%s: %s", function, error.c_str());
  const std::string& text = host_of(lua).chunk(chunk).text;
  count_work(lua, text.size() / 4 * kInstructionsPerWord / 10);
  return text;
}

// "a.csv:3: not a pose: expected 8 values, found 7", or without a line "a.csv has no pose".
int raise(lua_State* lua, const Diagnostic& d) {
  std::string text = d.line > 0 ? d.file + ":" + std::to_string(d.line) + ": " + d.message : d.file + " " + d.message;
  if (!d.expected.empty()) text += ": expected " + d.expected;
  if (!d.found.empty()) text += (d.expected.empty() ? ": found " : ", found ") + d.found;
  if (!d.hint.empty()) text += " (" + d.hint + ")";
  return luaL_error(lua, "%s", printable(text).c_str());
}

void push_text(lua_State* lua, std::string_view text) { lua_pushlstring(lua, text.data(), text.size()); }

void set_text(lua_State* lua, const char* key, std::string_view text) {
  push_text(lua, text);
  lua_setfield(lua, -2, key);
}

void push_list(lua_State* lua, const std::vector<std::string>& texts) {
  lua_createtable(lua, int(texts.size()), 0);
  lua_Integer i = 0;
  for (const std::string& text : texts) {
    push_text(lua, text);
    lua_rawseti(lua, -2, ++i);
  }
}

// A word as a number where it is a finite one.
void push_word(lua_State* lua, std::string_view word) {
  const auto number = parse_number(word);
  if (number && std::isfinite(*number))
    lua_pushnumber(lua, *number);
  else
    push_text(lua, word);
}

void push_words(lua_State* lua, const TextRow& row) {
  lua_createtable(lua, int(row.words.size()), 0);
  lua_Integer i = 0;
  for (const std::string_view word : row.words) {
    push_word(lua, word);
    lua_rawseti(lua, -2, ++i);
  }
}

bool has_number(const TextRow& row) {
  return std::any_of(row.words.begin(), row.words.end(), [](std::string_view word) {
    const auto number = parse_number(word);
    return number && std::isfinite(*number);
  });
}

// A comment before the first row with as many words between the same separators, commas or semicolons.
const TextRow* named_by_comment(const TextTable& table) {
  if (table.rows.empty() || table.rows[0].separator == ' ') return nullptr;
  const TextRow& first = table.rows[0];
  const TextRow* found = nullptr;
  for (const TextRow& comment : table.comments)
    if (comment.line < first.line && comment.separator == first.separator &&
        comment.words.size() == first.words.size() && !has_number(comment))
      found = &comment;
  return found;
}

// read_table(file) -> { names = {...}, rows = {{...}, ...}, lines = {...} }: the words of each line,
// between commas, semicolons or blanks; `#` begins a comment. names: a first line that holds no number.
int read_table_file(lua_State* lua) {
  const std::string name = text_argument(lua, 1);
  const std::string& text = text_of(lua, "rubble.read_table", name);
  TextTable table = read_text_table(text);
  // The head of an accelerogram has numbers among its words, and no row of the table.
  const int head = int(accelerogram_head_lines(text));
  table.rows.erase(table.rows.begin(), std::find_if(table.rows.begin(), table.rows.end(), [head](const TextRow& row) {
                     return row.line > head;
                   }));
  std::size_t first = 0;
  lua_createtable(lua, 0, 3);
  const bool words = !table.rows.empty() && !has_number(table.rows[0]);
  const TextRow* const names = words ? &table.rows[0] : named_by_comment(table);
  if (words) first = 1;
  names ? push_words(lua, *names) : lua_newtable(lua);
  lua_setfield(lua, -2, "names");
  lua_newtable(lua), lua_newtable(lua);
  for (std::size_t i = first; i < table.rows.size(); ++i) {
    push_words(lua, table.rows[i]);
    lua_rawseti(lua, -3, lua_Integer(i - first) + 1);
    lua_pushinteger(lua, table.rows[i].line);
    lua_rawseti(lua, -2, lua_Integer(i - first) + 1);
  }
  lua_setfield(lua, -3, "lines");
  lua_setfield(lua, -2, "rows");
  return 1;
}

// read_image(file, side) -> { columns =, rows =, values = {...}, metric =, levels =, block =, cut_columns =, cut_rows =,
// spacing =, east =, north =, degrees =, colour = }: grey levels from 0 to 1, or heights in m.
int read_image_file(lua_State* lua) {
  const std::string name = text_argument(lua, 1);
  const lua_Integer side = luaL_optinteger(lua, 2, kUsualSide);
  luaL_argcheck(lua, side >= 2 && side <= kLargestSide, 2, "2 to 900 points a side");
  std::string error;
  const int chunk = host_of(lua).open_grid(name, int(side), error);
  DataGrid grid;
  if (chunk >= 0) grid = read_data_grid(host_of(lua).chunk(chunk).text, true);
  if (chunk < 0) return luaL_error(lua, "rubble.read_image: %s", printable(error).c_str());
  count_work(lua, grid.values.size() * kInstructionsPerWord);
  lua_createtable(lua, 0, 13);
  const auto set = [lua](const char* key, double value) { lua_pushnumber(lua, value), lua_setfield(lua, -2, key); };
  const auto set_flag = [lua](const char* key, bool value) { lua_pushboolean(lua, value), lua_setfield(lua, -2, key); };
  lua_pushinteger(lua, grid.columns), lua_setfield(lua, -2, "columns");
  lua_pushinteger(lua, grid.rows), lua_setfield(lua, -2, "rows");
  lua_pushinteger(lua, grid.block), lua_setfield(lua, -2, "block");
  lua_pushinteger(lua, grid.cut_columns), lua_setfield(lua, -2, "cut_columns");
  lua_pushinteger(lua, grid.cut_rows), lua_setfield(lua, -2, "cut_rows");
  set_flag("metric", grid.metric()), set_flag("degrees", grid.degrees), set_flag("colour", grid.colour);
  if (!grid.metric()) set("levels", grid.white + 1);
  if (grid.spacing > 0) set("spacing", grid.spacing), set("east", grid.east), set("north", grid.north);
  lua_createtable(lua, int(grid.values.size()), 0);
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    lua_pushnumber(lua, grid.metric() ? grid.values[i] : grid.values[i] / grid.white);
    lua_rawseti(lua, -2, lua_Integer(i) + 1);
  }
  lua_setfield(lua, -2, "values");
  return 1;
}

// The second argument, where there is one, is a table with some of these keys.
void check_options(lua_State* lua, const char* function, const std::vector<std::string>& keys) {
  if (lua_isnoneornil(lua, 2)) return;
  luaL_checktype(lua, 2, LUA_TTABLE);
  std::string known, unknown;
  for (const std::string& key : keys) known += (known.empty() ? "" : ", ") + key;
  for (lua_pushnil(lua); lua_next(lua, 2) != 0; lua_pop(lua, 1)) {
    const bool is_text = lua_type(lua, -2) == LUA_TSTRING;
    const std::string key = is_text ? lua_tostring(lua, -2) : std::string("a ") + luaL_typename(lua, -2);
    if (is_text && std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    if (unknown.empty() || key < unknown) unknown = key;  // their order changes from run to run
  }
  if (!unknown.empty())
    luaL_error(lua, "%s: unknown key `%s`: expected %s", function, printable(unknown).c_str(), known.c_str());
}

// read_calibration(file) -> { format =, notes =, and the keys of sensors by their kinds }
int read_calibration_file(lua_State* lua) {
  const std::string name = text_argument(lua, 1);
  SensorCalibration read;
  Diagnostic mistake;
  try {
    read = parse_calibration(text_of(lua, "rubble.read_calibration", name), name);
  } catch (const InputError& error) {
    mistake = error.diagnostics().front();
  }
  if (read.format.empty()) return raise(lua, mistake);
  push_lua_value(lua, read.keys);
  set_text(lua, "format", read.format);
  push_list(lua, read.notes), lua_setfield(lua, -2, "notes");
  return 1;
}

// read_accelerogram(file, { step =, unit = }) -> { values = {...} in m/s2, step =, peak =, format =, notes = }
int read_accelerogram_file(lua_State* lua) {
  const std::string name = text_argument(lua, 1);
  AccelerogramOptions options;
  check_options(lua, "rubble.read_accelerogram", {"step", "unit"});
  if (!lua_isnoneornil(lua, 2)) {
    if (lua_getfield(lua, 2, "step") != LUA_TNIL) options.step = luaL_checknumber(lua, -1);
    lua_getfield(lua, 2, "unit");
    options.unit = luaL_optstring(lua, -1, "");
    lua_settop(lua, 2);
  }
  Accelerogram record;
  Diagnostic mistake;
  try {
    record = parse_accelerogram(text_of(lua, "rubble.read_accelerogram", name), name, options);
  } catch (const InputError& error) {
    mistake = error.diagnostics().front();
  }
  if (record.values.empty()) return raise(lua, mistake);
  lua_createtable(lua, 0, 5);
  lua_pushnumber(lua, record.step), lua_setfield(lua, -2, "step");
  lua_pushnumber(lua, record.peak), lua_setfield(lua, -2, "peak");
  set_text(lua, "format", record.format);
  push_list(lua, record.notes), lua_setfield(lua, -2, "notes");
  lua_createtable(lua, int(record.values.size()), 0);
  for (std::size_t i = 0; i < record.values.size(); ++i) {
    lua_pushnumber(lua, record.values[i]);
    lua_rawseti(lua, -2, lua_Integer(i) + 1);
  }
  lua_setfield(lua, -2, "values");
  return 1;
}

void push_vector(lua_State* lua, const Vec3& v) {
  lua_createtable(lua, 3, 0);
  for (int i = 0; i < 3; ++i) {
    lua_pushnumber(lua, v[i]);
    lua_rawseti(lua, -2, i + 1);
  }
}

// Of the options of read_trajectory; empty: not given.
std::string option_at(lua_State* lua, const char* key) {
  if (lua_isnoneornil(lua, 2)) return "";
  if (lua_getfield(lua, 2, key) != LUA_TNIL && lua_type(lua, -1) != LUA_TSTRING)
    luaL_error(lua, "rubble.read_trajectory: %s: expected a string, found a %s", key, luaL_typename(lua, -1));
  const std::string value = luaL_optstring(lua, -1, "");
  lua_pop(lua, 1);
  return value;
}

void push_pose(lua_State* lua, const RecordedTrajectory& track, std::size_t i, bool optical) {
  const Pose pose = body_pose(track.poses[i].world_from_body, optical, track.optical_world);
  const std::int64_t time = track.poses[i].stamp_ns - track.poses.front().stamp_ns;
  lua_createtable(lua, 0, 3);
  lua_pushnumber(lua, double(time) / 1e9), lua_setfield(lua, -2, "t");
  push_vector(lua, pose.translation), lua_setfield(lua, -2, "position");
  if (!track.has_rotations) return;
  const bool as_written = !optical && !track.rpy_deg.empty();
  push_vector(lua, as_written ? track.rpy_deg[i] : portable::rpy_from_quat(pose.rotation) * (180 / portable::kPi));
  lua_setfield(lua, -2, "rpy_deg");
}

// read_trajectory(file, { frame = "optical" or "body", columns = }) -> { format =, stamped =, poses = {
// { t =, position =, rpy_deg = }, ... }, notes = {...} }: bodies have X forward and Z up; t from the first
// pose, in s; of poses with one stamp the first.
int read_trajectory_file(lua_State* lua) {
  const std::string name = text_argument(lua, 1);
  check_options(lua, "rubble.read_trajectory", {"frame", "columns"});
  const std::string frame = option_at(lua, "frame"), columns = option_at(lua, "columns");
  const bool frame_is_known = frame.empty() || frame == "optical" || frame == "body" || frame == "as the format says";
  if (!frame_is_known)
    return luaL_error(lua, "rubble.read_trajectory: frame: expected \"optical\", \"body\" or \"as the format says\", found \"%s\"",
                      printable(frame).c_str());
  RecordedTrajectory track;
  Diagnostic mistake;
  try {
    track = parse_trajectory(text_of(lua, "rubble.read_trajectory", name), name, columns);
  } catch (const InputError& error) {
    mistake = error.diagnostics().front();
  }
  if (track.poses.empty()) return raise(lua, mistake);
  const bool optical = frame == "optical" || (frame != "body" && track.optical);
  lua_createtable(lua, 0, 4);
  set_text(lua, "format", track.format + ", orientations of " + (optical ? "the optical frame" : "the body"));
  lua_pushboolean(lua, track.has_stamps), lua_setfield(lua, -2, "stamped");
  lua_createtable(lua, int(track.poses.size()), 0);
  lua_Integer count = 0;
  for (std::size_t i = 0; i < track.poses.size(); ++i) {
    if (i > 0 && track.poses[i].stamp_ns == track.poses[i - 1].stamp_ns) continue;
    push_pose(lua, track, i, optical);
    lua_rawseti(lua, -2, ++count);
  }
  lua_setfield(lua, -2, "poses");
  push_list(lua, track.notes), lua_setfield(lua, -2, "notes");
  return 1;
}

}  // namespace

void add_file_functions(lua_State* lua) {
  const luaL_Reg functions[] = {{"read_table", read_table_file},
                                {"read_image", read_image_file},
                                {"read_trajectory", read_trajectory_file},
                                {"read_accelerogram", read_accelerogram_file},
                                {"read_calibration", read_calibration_file},
                                {nullptr, nullptr}};
  luaL_setfuncs(lua, functions, 0);
}

}  // namespace rubble
