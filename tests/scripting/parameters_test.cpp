// Parameters of scripts, and options of the functions that they call, from outside: --set and --vary.
#include <gtest/gtest.h>

#include "tests/scripting/test_support.h"

namespace rubble {
namespace parameters_test {

const char kScript[] = R"(
local height = rubble.parameter("height", 2.4, { min = 1, max = 3, unit = "m" })
local name = rubble.parameter("look", "brick")
local count = rubble.parameter("count", 3, { type = "integer", min = 0 })
local at = rubble.parameter("at", { 1, 2, 3 })
local many = rubble.parameter("many", false)
return rubble.mission {
  pile = { layers = count, mix = { { asset = name } }, spawn_position = at, spawn_bounds = { many and 9 or 4, 4, height } },
})";

PileScenario pile_with(std::vector<std::string> overrides) {
  return load_text(kScript, with_overrides(std::move(overrides))).scenario.pile;
}

TEST(Parameters, HaveTheirDefaults) {
  const Mission mission = load_text(kScript);
  EXPECT_EQ(mission.scenario.pile.spawn_bounds.z, 2.4);
  EXPECT_EQ(mission.scenario.pile.layers, 3);
  EXPECT_EQ(mission.parameters.at("height"), "2.4");
  EXPECT_EQ(mission.parameters.size(), 5u);
}

TEST(Parameters, TakeValuesFromOutside) {
  const PileScenario pile = pile_with({"height=1.5", "count=7", "look=12", "at=4,5,6", "many=true"});
  EXPECT_EQ(pile.spawn_bounds.z, 1.5);
  EXPECT_EQ(pile.layers, 7);
  EXPECT_EQ(pile.mix.at(0).asset, "12");
  EXPECT_EQ(pile.spawn_position.y, 5);
  EXPECT_EQ(pile.spawn_bounds.x, 9);
  EXPECT_EQ(pile_with({"height=1.5", "height=2"}).spawn_bounds.z, 2) << "the last one counts";
  // A key of the mission still comes after the script.
  EXPECT_EQ(pile_with({"count=7", "pile.layers=1"}).layers, 1);
}

TEST(Parameters, AreCheckedLikeKeys) {
  const auto error = [](const std::string& text) { return mission_error(kScript, with_overrides({text})); };
  EXPECT_EQ(error("height=9"), "--set: height: out of range: expected a number from 1 to 3, found 9");
  EXPECT_NE(error("count=2.5").find("--set: count: "), std::string::npos) << error("count=2.5");
  EXPECT_NE(error("many=5").find("--set: many: "), std::string::npos);
  EXPECT_NE(error("heigth=2").find("did you mean `height`"), std::string::npos) << error("heigth=2");
  EXPECT_NE(error("nothing=2").find("the script declares at, count, height, look, many"), std::string::npos);
}

TEST(Parameters, HaveNamesOfTheirOwn) {
  EXPECT_NE(mission_error("rubble.parameter('pile', 1) return {}").find("is a key of the mission"), std::string::npos);
  EXPECT_NE(mission_error("rubble.parameter('fogdensity', 1) return {}").find("is a key of the mission"), std::string::npos);
  EXPECT_NE(mission_error("rubble.parameter('a b', 1) return {}").find("a word of letters"), std::string::npos);
  EXPECT_NE(mission_error("rubble.parameter('x', 5, { max = 3 }) return {}").find("m.lua:1: rubble.parameter"), std::string::npos);
  EXPECT_NE(mission_error("rubble.parameter('x') return {}").find("no type"), std::string::npos);
  EXPECT_NE(mission_error("rubble.parameter('x', 'a', { among = { 'a', 'b' } }) return {}")
                .find("has the unknown key `among`: expected min, above, max, unit, type, choices or doc"), std::string::npos);
  EXPECT_NE(mission_error("rubble.parameter() return {}"), "");
}

const char kMode[] = "return { pile = rubble.collapse.lean_to { length = 6, height = 2 } }";

TEST(Parameters, OfModesAreReachedByTheNamesOfTheirErrors) {
  const auto highest = [](std::vector<std::string> overrides) {
    return load_text(kMode, with_overrides(std::move(overrides))).scenario.pile;
  };
  EXPECT_EQ(highest({"rubble.collapse.lean_to.debris.layers=0"}).layers, 0);
  EXPECT_EQ(highest({"rubble.collapse.lean_to.debris.layers=2"}).layers, 2);
  EXPECT_NE(highest({"rubble.collapse.lean_to.length=8"}).placed.at(1).position.x, highest({}).placed.at(1).position.x) << "the slab";
}

TEST(Parameters, OfModesAreChecked) {
  const auto error = [](const std::string& text) { return mission_error(kMode, with_overrides({text})); };
  EXPECT_NE(error("rubble.collapse.lean_to.hieght=2").find("did you mean"), std::string::npos)
      << error("rubble.collapse.lean_to.hieght=2");
  EXPECT_NE(error("rubble.collapse.lean_to.length=wide").find("--set: rubble.collapse.lean_to.length: wrong type"),
            std::string::npos) << error("rubble.collapse.lean_to.length=wide");
  EXPECT_NE(error("rubble.collapse.pancake.storeys=2"), "") << "the script does not call it";
  // What only the mode can see.
  EXPECT_NE(error("rubble.collapse.lean_to.length=2").find("less than 0.9 times the length"), std::string::npos);
}

TEST(Parameters, OfFunctionsOfOnesOwn) {
  const std::string script = "local function wall(given) return rubble.options('wall', given, { { 'layers', 1, type = 'integer' } }) end\n"
                             "return { pile = { layers = wall { layers = 2 }.layers } }";
  EXPECT_EQ(load_text(script).scenario.pile.layers, 2);
  EXPECT_EQ(load_text(script, with_overrides({"wall.layers=5"})).scenario.pile.layers, 5);
}

TEST(Parameters, AreDescribedByTheRightTypes) {
  const auto error = [](const std::string& limits) {
    return mission_error("rubble.parameter('x', 2, { " + limits + " }) return {}");
  };
  EXPECT_EQ(error("min = 1, max = 3, unit = 'm', doc = 'width'"), "");
  for (const char* limits : {"min = '5'", "max = {}", "above = true", "unit = 5", "doc = {}", "type = 5"})
    EXPECT_NE(error(limits).find("expected a "), std::string::npos) << limits << ": " << error(limits);
  const auto choices = [](const std::string& text) {
    return mission_error("rubble.parameter('x', 'a', { choices = " + text + " }) return {}");
  };
  EXPECT_EQ(choices("{ 'a', 'b' }"), "");
  for (const char* text : {"'a'", "{}", "{ 'a', 1 }", "{ a = 'a' }"})
    EXPECT_NE(choices(text).find("expected a list of strings"), std::string::npos) << text << ": " << choices(text);
  EXPECT_NE(choices("{ 'a' }, type = 'number'").find("leave the type out"), std::string::npos);
}

}  // namespace parameters_test
}  // namespace rubble
