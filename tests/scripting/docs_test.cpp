#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "scripting/mission.h"
#include "scripting/reference/schema_docs.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/scenario/mission_form.h"
#include "scripting/scenario/scenario.h"

namespace rubble {
namespace docs_test {

using Json = nlohmann::ordered_json;

// A file of the library that RUBBLE_LUA_NAMES does not name would silently be no part of it.
TEST(Library, HasEveryFile) {
  std::ostringstream text;
  for (const char* list : {"/scripting/CMakeLists.txt", "/scripting/robots/CMakeLists.txt"})
    text << std::ifstream(std::string(RUBBLE_SOURCE_DIR) + list).rdbuf();
  const std::string cmake = text.str();
  const auto words_of = [&](const std::string& list) {
    const std::size_t begin = cmake.find("set(" + list + " "), lines = cmake.find("set(" + list + "\n");
    const std::size_t first = std::min(begin, lines) + list.size() + 4;
    std::istringstream words(cmake.substr(first, cmake.find(')', first) - first));
    return std::set<std::string>{std::istream_iterator<std::string>(words), {}};
  };
  std::set<std::string> listed = words_of("RUBBLE_LUA_NAMES");
  ASSERT_EQ(listed.erase("${robot_library}"), 1u);
  for (const std::string& robot : words_of("RUBBLE_ROBOTS")) listed.insert("robot/" + robot);
  const std::filesystem::path folder = RUBBLE_SOURCE_DIR "/scripting/lua";
  std::size_t files = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
    if (file.path().extension() != ".lua") continue;
    const std::string name =
        std::filesystem::relative(file.path(), folder).replace_extension().generic_string();
    EXPECT_EQ(listed.count(name), 1u) << name << " is not in RUBBLE_LUA_NAMES";
    ++files;
  }
  EXPECT_EQ(files, listed.size()) << "a name without a file";
}

TEST(Missions, OfTheProjectAreSound) {
  int missions = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(RUBBLE_SOURCE_DIR "/scripts")) {
    if (file.path().extension() != ".lua") continue;
    std::ostringstream text;
    text << std::ifstream(file.path()).rdbuf();
    if (text.str().find("return rubble.mission") == std::string::npos) continue;
    EXPECT_NO_THROW(load_mission(file.path().string())) << file.path();
    ++missions;
  }
  EXPECT_GT(missions, 50);
}

TEST(LuaReference, DocumentIsUpToDate) {
  std::ostringstream text;
  text << std::ifstream(RUBBLE_SOURCE_DIR "/docs/reference/missions.md").rdbuf();
  EXPECT_TRUE(with_reference(text.str()) == text.str())
      << "run: cmake --build build/release --target lua_reference";
}

// Names of the functions of a table `rubble`, one a line, as a script sees them after `before`.
std::string function_names(const std::string& before) {
  LuaSandbox sandbox(1, "rubble.mission");
  const Value names = sandbox.run(before + R"(
    local names = ""
    local function list(at, prefix)
      for name, value in pairs(at) do
        if type(value) == "table" then list(value, prefix .. name .. ".") end
        if type(value) == "function" then names = names .. prefix .. name .. "\n" end
      end
    end
    list(rubble, "rubble.")
    return { names })", "names.lua");
  return names.items.at(0).text;
}

TEST(LuaAnnotations, HaveTheFunctionsThatAScriptHas) {
  const std::string names = function_names("");
  EXPECT_NE(names.find("rubble.collapse.lean_to\n"), std::string::npos) << names;
  EXPECT_EQ(function_names(lua_annotations()), names);
}

TEST(LuaAnnotations, HaveEveryKeyWithItsType) {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  const std::string text = lua_annotations();
  for (const Key& key : schema.keys())
    EXPECT_NE(text.find("---@field " + key.name() + (key.required ? " " : "? ")), std::string::npos)
        << key.path;
  for (const char* line :
       {"---@field layers? integer Number of layers", "---@class rubble.mission.pile.mix\n",
        "---@field mix? rubble.mission.pile.mix[] ", "---@field asset string ",
        "---@param options? rubble.collapse.lean_to.Options\n---@return rubble.mission.pile\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST(LuaReference, MarkersMustBeThere) {
  EXPECT_THROW(with_reference("no markers"), std::runtime_error);
}

TEST(LuaReference, HasEveryKeyAndName) {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  const std::string text = lua_reference();
  for (const Key& key : schema.keys()) {
    const bool row = text.find("|`" + key.name() + "`|") != std::string::npos;
    const bool section = text.find("### `" + key.path + "`\n") != std::string::npos;
    EXPECT_TRUE(key.kind == KeyKind::value ? row || section : section) << key.path;
    EXPECT_FALSE(key.doc_text.empty()) << key.path;
    EXPECT_EQ(key.doc_text.find('\n'), std::string::npos) << key.path;
  }
  for (const Alias& alias : schema.aliases())
    EXPECT_NE(text.find("|`" + alias.name + "`|"), std::string::npos) << alias.name;
}

TEST(LuaReference, RowsHaveTypeUnitRangeAndDefault) {
  const std::string text = lua_reference();
  for (const char* row :
       {"|`layers`|integer|0..1000|`4`|Number", "|`spawn_bounds`|vector, m|>0..1000|`{10, 10, 7}`|", "|`seed`|integer|>=0|`0`|",
        "|`schedule`|choice|`layers`, `planes`|`\"layers\"`|", "|`asset`|string||required|", "|`full_well`|number|10..1e7|`10000`|",
        "|`collision`|choice|`hull`, `decompose`, `{ parts = \"FILE\" }`|"})
    EXPECT_NE(text.find(row), std::string::npos) << row;
}

// A key of one camera comes once, though each of `cameras` has it too.
TEST(LuaReference, NamedTablesDoNotRepeatTheKeysOfTheSingleOne) {
  const std::string text = lua_reference();
  const std::size_t first = text.find("|`stereo_baseline`|");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("|`stereo_baseline`|", first + 1), std::string::npos);
  const std::size_t noise = text.find("|`gyroscope_noise`|");
  EXPECT_EQ(text.find("|`gyroscope_noise`|", noise + 1), std::string::npos);
  EXPECT_NE(text.find("As keys of `trajectory`: `max_speed`"), std::string::npos);
}

TEST(LuaReference, LinksToThePagesThatTextsName) {
  const std::string text = lua_reference();
  EXPECT_NE(text.find("([weather.md](../explanation/weather.md))"), std::string::npos);
  EXPECT_NE(text.find("([robots.md](robots.md))"), std::string::npos);
  EXPECT_EQ(text.find("docs/"), std::string::npos) << text.substr(text.find("docs/") - 50, 100);
}

// Everything a reader copies from the page.
TEST(LuaReference, EveryMissionOfThePageLoads) {
  std::ostringstream page;
  page << std::ifstream(RUBBLE_SOURCE_DIR "/docs/reference/missions.md").rdbuf();
  const std::string text = page.str();
  int count = 0;
  for (std::size_t at = text.find("```lua\n"); at != std::string::npos; ++count) {
    const std::size_t begin = at + 7, end = text.find("```", begin);
    const std::string script = text.substr(begin, end - begin);
    EXPECT_NO_THROW(load_mission_text(script, "tutorial.lua")) << script;
    at = text.find("```lua\n", end);
  }
  EXPECT_GE(count, 4);
}

// A small validator of the parts of JSON Schema that are used: it says where the text fails.
std::string failure(const Json& schema, const Json& value, const std::string& path) {
  if (schema.contains("anyOf")) {
    for (const Json& option : schema["anyOf"])
      if (failure(option, value, path).empty()) return "";
    return path + " fits no option";
  }
  if (schema.contains("enum")) {
    for (const Json& option : schema["enum"])
      if (option == value) return "";
    return path + " is no choice";
  }
  const std::string type = schema.value("type", "");
  if (type == "null" && !value.is_null()) return path + " is not null";
  if (type == "boolean" && !value.is_boolean()) return path + " is no boolean";
  if (type == "string" && !value.is_string()) return path + " is no string";
  if (type == "integer" && !value.is_number_integer()) return path + " is no integer";
  if (type == "number" && !value.is_number()) return path + " is no number";
  if (type == "number" || type == "integer") {
    const double number = value.get<double>();
    if (schema.contains("minimum") && number < schema["minimum"].get<double>())
      return path + " low";
    if (schema.contains("maximum") && number > schema["maximum"].get<double>())
      return path + " high";
    if (schema.contains("exclusiveMinimum") && number <= schema["exclusiveMinimum"].get<double>())
      return path + " low";
  }
  if (type == "array") {
    if (!value.is_array()) return path + " is no array";
    for (std::size_t i = 0; i < value.size(); ++i)
      if (auto f = failure(schema["items"], value[i], path + "[]"); !f.empty()) return f;
    if (schema.contains("minItems") && value.size() != schema["minItems"].get<std::size_t>())
      return path + " has another length";
  }
  if (type == "object") {
    if (!value.is_object()) return path + " is no object";
    for (const auto& [name, member] : value.items()) {
      const bool listed = schema.contains("properties") && schema["properties"].contains(name);
      if (!listed && !(schema.contains("additionalProperties") && schema["additionalProperties"].is_object()))
        return path + "." + name + " is unknown";
      if (auto f = failure(listed ? schema["properties"][name] : schema["additionalProperties"], member, path + "." + name); !f.empty())
        return f;
    }
    for (const Json& name : schema.value("required", Json::array()))
      if (!value.contains(name.get<std::string>())) return path + " lacks " + name.dump();
  }
  return "";
}

TEST(JsonSchema, AcceptsTheDefaultScenarioAndRejectsMistakes) {
  const Json schema = Json::parse(mission_json_schema());
  EXPECT_EQ(schema["title"], "Rubble mission");
  Json scenario = Json::parse(scenario_to_json(Scenario{}));
  EXPECT_EQ(failure(schema, scenario, "$"), "");
  EXPECT_EQ(failure(schema, Json::parse(R"({"numlayers": 3, "setlightrot": true})"), "$"), "");
  const auto spoiled = [&](const char* pointer, const Json& value) {
    Json copy = scenario;
    copy[Json::json_pointer(pointer)] = value;
    return failure(schema, copy, "$");
  };
  EXPECT_EQ(spoiled("/pile/layers", -1), "$.pile.layers low");
  EXPECT_EQ(spoiled("/pile/layers", 2.5), "$.pile.layers is no integer");
  EXPECT_EQ(spoiled("/pile/layres", 2), "$.pile.layres is unknown");
  EXPECT_EQ(spoiled("/pile/spawn_bounds", Json::array({1, 2})),
            "$.pile.spawn_bounds fits no option");
  EXPECT_EQ(spoiled("/settle/schedule", "plane"), "$.settle.schedule is no choice");
  EXPECT_EQ(spoiled("/trajectory/waypoints", Json::array({Json::object()})),
            "$.trajectory.waypoints[] lacks \"position\"");
}

// Also those of items of lists, of which the default scenario has none.
TEST(JsonSchema, AcceptsItsOwnDefaults) {
  int count = 0;
  const std::function<void(const Json&, const std::string&)> walk = [&](const Json& node, const std::string& path) {
    if (node.is_object() && node.contains("default") && node.contains("description")) {
      ++count;
      EXPECT_EQ(failure(node, node["default"], path), "");
    }
    if (!node.is_structured()) return;
    for (const auto& [name, member] : node.items()) walk(member, path + "/" + name);
  };
  walk(Json::parse(mission_json_schema()), "");
  EXPECT_GT(count, 500);
  Scenario scenario;
  scenario.robots.resize(1);
  scenario.robots[0].efforts = {{"wheel", 5}};
  EXPECT_EQ(failure(Json::parse(mission_json_schema()), Json::parse(scenario_to_json(scenario)), "$"), "");
}

TEST(JsonSchema, HoldsTheDefaults) {
  const Json schema = Json::parse(mission_json_schema());
  const Json pile = schema["properties"]["pile"]["properties"];
  EXPECT_EQ(pile["layers"]["default"], 4);
  EXPECT_EQ(pile["spawn_bounds"]["default"], Json::array({10.0, 10.0, 7.0}));
  EXPECT_EQ(schema["properties"]["light"]["properties"]["type"]["default"], "directional");
}

}  // namespace docs_test
}  // namespace rubble
