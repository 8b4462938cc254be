// The parameters of collapse modes are checked as a mission's own keys are.
#include <gtest/gtest.h>

#include "scripting/sandbox/lua_library.h"
#include "scripting/sandbox/lua_options.h"
#include "tests/scripting/test_support.h"

namespace rubble {
namespace collapse_errors_test {

TEST(CollapseErrors, NameFileLineAndWhatWasMeant) {
  EXPECT_EQ(mission_error("return rubble.mission {\n  pile = rubble.collapse.lean_to { hieght = 1 },\n}"),
            "m.lua:2: rubble.collapse.lean_to.hieght: unknown key `hieght` (did you mean `height`?)");
}

TEST(CollapseErrors, AllInOneRunEachOnItsLine) {
  EXPECT_EQ(mission_error(R"(local pile = rubble.collapse.pancake {
  gap = "wide",
  storeys = 0.5,
  debris = {
    layers = -1,
    mixx = 3,
  },
}
pile.layres = 2
return rubble.mission {
  pile = pile,
  lamps = {},
})"),
            "m.lua:2: rubble.collapse.pancake.gap: wrong type: expected a number from 0.05 to 5, "
            "found the string \"wide\"\n"
            "m.lua:3: rubble.collapse.pancake.storeys: wrong type: expected an integer from 1 to "
            "30, found 0.5\n"
            "m.lua:5: rubble.collapse.pancake.debris.layers: out of range: expected an integer from "
            "0 to 1000, found -1\n"
            "m.lua:6: rubble.collapse.pancake.debris.mixx: unknown key `mixx` (did you mean `mix`?)\n"
            "m.lua:9: pile.layres: unknown key `layres` (did you mean `layers`?)\n"
            "m.lua:12: lamps: unknown key `lamps` (did you mean `lamp`?)");
}

TEST(CollapseErrors, WhatOnlyTheModeCanSee) {
  EXPECT_EQ(mission_error("return { pile = rubble.collapse.lean_to {\n length = 2,\n height = 3 } }"),
            "m.lua:3: rubble.collapse.lean_to.height: out of range: expected less than 0.9 times the "
            "length, found 3");
  EXPECT_EQ(mission_error("return { pile = rubble.collapse.cantilever { droop_deg = 60 } }"),
            "m.lua:1: rubble.collapse.cantilever.droop_deg: out of range: expected a slab that hangs "
            "clear of the floor, found 60");
  EXPECT_NE(mission_error("return { pile = rubble.collapse.a_frame { height = 4.2 } }"), "");
  EXPECT_NE(mission_error("return { pile = rubble.collapse.v_shape { height = 4.2 } }"), "");
  EXPECT_NE(mission_error("return { pile = rubble.collapse.inclined { spread_deg = 0.5 } }"), "");
}

TEST(CollapseErrors, WrongWaysToCall) {
  EXPECT_EQ(mission_error("return { pile = rubble.collapse.lean_to(5) }"),
            "m.lua:1: rubble.collapse.lean_to: wrong type: expected a table, found 5 "
            "(write rubble.collapse.lean_to{ ... })");
  EXPECT_EQ(mission_error("return { pile = rubble.collapse.lean_to { 5 } }"),
            "m.lua:1: rubble.collapse.lean_to[1]: a value without a name: expected named fields, "
            "found 5 (write `name = value`)");
  EXPECT_EQ(mission_error("return { pile = rubble.collapse.lean_too {} }"),
            "m.lua:1: attempt to call a nil value (field 'lean_too') "
            "(did you mean `rubble.collapse.lean_to`?)");
  EXPECT_EQ(mission_error("return { pile = rubble.collapse.free { pieces = { { box = {1, 1, 1} } } } }"),
            "");
  EXPECT_NE(mission_error("return { pile = rubble.collapse.free { pieces = { 5 } } }"), "");
  EXPECT_NE(mission_error("return { pile = rubble.collapse.free { pieces = { print } } }"), "");
}

TEST(CollapseErrors, OptionsInAVariableHaveTheLineOfTheCall) {
  EXPECT_EQ(mission_error("local o = { hieght = 1 }\n\nreturn { pile = rubble.collapse.lean_to(o) }"),
            "m.lua:3: rubble.collapse.lean_to.hieght: unknown key `hieght` (did you mean `height`?)");
}

// A mode of the user's own has the same checks from the same primitive.
TEST(CollapseErrors, AModeOfOnesOwn) {
  const std::string mode = R"(
local function shed(given)
  local o = rubble.options("shed", given, rubble.structure_options {
    { "size", { 3, 2, 2 }, min = 0.5, max = 9, unit = "m", doc = "Of the shed." },
    { "roof", "flat", choices = { "flat", "none" }, doc = "What covers it." },
  })
  return rubble.assemble(o, { { box = o.size, position = { 0, 0, o.size[3] / 2 } } })
end
)";
  EXPECT_EQ(mission_error(mode + "return { pile = shed { roof = 'none', size = {1, 1, 1} } }"), "");
  EXPECT_EQ(mission_error(mode + "return { pile = shed {\n roof = 'flet', size = {1, 1},\n yaw = 3 } }"),
            "m.lua:10: shed.roof: unknown choice: expected one of \"flat\", \"none\", found the string "
            "\"flet\" (did you mean \"flat\"?)\n"
            "m.lua:10: shed.size: wrong type: expected three numbers {x, y, z}, each from 0.5 to 9, "
            "found {1, 1}\n"
            "m.lua:11: shed.yaw: unknown key `yaw` (did you mean `yaw_deg`?)");
}

TEST(CollapseErrors, ADescriptionThatMakesNoSense) {
  EXPECT_EQ(mission_error("rubble.options('f', {}, { { 'a' } })"),
            "m.lua:1: rubble.options: entry 1 (`a`) has no type: give a default or `type`");
  EXPECT_EQ(mission_error("rubble.options('f', {}, { { 'a', 1 }, {} })"),
            "m.lua:1: rubble.options: entry 2 has no name");
  EXPECT_NE(mission_error("rubble.options('f', {}, { { 'a', 7, max = 5 } })"), "");
  EXPECT_NE(mission_error("rubble.options('f', {}, 5)"), "");
  EXPECT_NE(mission_error("rubble.options()"), "");
}

TEST(PlacedErrors, AssetOrBox) {
  EXPECT_EQ(mission_error(R"(return rubble.mission { pile = { placed = {
    { position = {0, 0, 1} },
    { asset = "brick", box = {1, 1, 1} },
    { box = {1, 1, 0.001} },
    { box = {1, 1, 1}, broken = { "top" } } } } })"),
            "m.lua:4: pile.placed[3].box: out of range: expected three numbers {x, y, z}, each from "
            "0.02 to 100, found {1, 1, 0.001}");
  EXPECT_EQ(mission_error(R"(return rubble.mission { pile = { placed = {
    { position = {0, 0, 1} },
    { asset = "brick", box = {1, 1, 1} },
    { box = {1, 1, 1}, broken = { "top" } } } } })"),
            "m.lua:2: pile.placed[1]: no piece: expected `asset = NAME` or `box = {x, y, z}`, found "
            "neither\n"
            "m.lua:3: pile.placed[2].box: contradicts asset: expected one of asset and box, found "
            "both\n"
            "m.lua:4: pile.placed[3].broken: no such face: expected some of \"+x\", \"-x\", \"+y\", "
            "\"-y\", \"+z\", \"-z\", found \"top\"");
}

// What the reference and the errors rest on: every mode describes itself whole.
TEST(CollapseLibrary, EveryParameterIsDescribed) {
  const std::vector<DescribedFunction> modes = LuaSandbox::describe_library();
  EXPECT_EQ(modes.size(), 11u + 4 + 1 + 6 + 1 + 7)
      << "modes, densities, terrain, paths, find_void and robots";
  for (const DescribedFunction& mode : modes) {
    OptionTable table(mode.description);
    for (const Key& key : table.schema().keys()) {
      EXPECT_TRUE(key.kind != KeyKind::value || !key.doc_text.empty()) << mode.name << key.path;
    }
  }
}

}  // namespace collapse_errors_test
}  // namespace rubble
