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
  EXPECT_EQ(modes.size(), 11u + 4 + 2 + 7 + 1 + 7 + 2)
      << "modes, densities, terrain, paths, find_void, robots, slab and wall";
  for (const DescribedFunction& mode : modes) {
    OptionTable table(mode.description);
    for (const Key& key : table.schema().keys()) {
      EXPECT_TRUE(key.kind != KeyKind::value || !key.doc_text.empty()) << mode.name << key.path;
    }
  }
}

PileScenario join(const std::string& parts) {
  return load_mission_text("return { pile = rubble.join(" + parts + ") }", "m.lua").scenario.pile;
}

TEST(JoinedPiles, KeepBuildingAndTerrain) {
  const PileScenario pile = join(
      "rubble.building { storeys = 2, bays_x = 1, cause = { weak_storey = 0 }, furniture = { { asset = 'table' } } }, "
      "rubble.collapse.lean_to { position = { 9, 0, 0 } }, "
      "{ terrain = rubble.terrain.from(function() return 1 end, { length = 2, width = 2, spacing = 1 }) }");
  EXPECT_EQ(pile.building.storeys, 2);
  EXPECT_EQ(pile.building.bays_x, 1);
  EXPECT_EQ(pile.building.cause.weak_storey, 0);
  EXPECT_EQ(pile.furniture.size(), 1u);
  EXPECT_EQ(pile.terrain.heights.size(), 9u);
  EXPECT_FALSE(pile.placed.empty());
  EXPECT_GT(pile.layers, 0);
  // In another order the same.
  EXPECT_EQ(join("rubble.collapse.lean_to {}, rubble.building { storeys = 3 }").building.storeys, 3);
}

// As many pieces fall where each part says as it has alone, spread as it says.
TEST(JoinedPiles, KeepDensitiesWhereTheyAre) {
  const std::string alone = "{ layers = 1, pieces_per_layer = 30, spawn_position = { 2, 0, 3 }, spawn_bounds = { 4, 2, 3 }, "
                            "spawn_density = { columns = 4, rows = 1, weights = { 0, 1, 0, 3 } } }";
  const PileScenario one = join(alone + ", rubble.building { storeys = 1 }");
  EXPECT_EQ(one.spawn_density.weights, (std::vector<double>{0, 1, 0, 3}));
  EXPECT_EQ(one.spawn_bounds.x, 4);
  const PileScenario two = join(alone + ", { layers = 2, pieces_per_layer = 10, spawn_position = { x = -1, y = 0, z = 3 }, "
                                        "spawn_bounds = { 2, 2, 3 } }");
  EXPECT_EQ(two.layers, 2);
  EXPECT_EQ(two.pieces_per_layer, 25) << "50 pieces together, as alone";
  EXPECT_EQ(two.spawn_position.x, 1);
  EXPECT_EQ(two.spawn_bounds.x, 6);
  ASSERT_EQ(two.spawn_density.columns, 6);
  ASSERT_EQ(two.spawn_density.rows, 1);
  const double right[] = {5, 5, 0, 3.75, 0, 11.25};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(two.spawn_density.weights[i], right[i], 1e-9) << i;
  EXPECT_TRUE(join("rubble.collapse.lean_to {}, rubble.collapse.pancake {}").spawn_density.weights.empty());
}

TEST(JoinedPiles, DropAsManyPiecesAsTheirParts) {
  const PileScenario mixed = join("{ layers = 10, pieces_per_layer = 1 }, { layers = 1, pieces_per_layer = 10 }");
  EXPECT_EQ(mixed.layers, 10);
  EXPECT_EQ(mixed.pieces_per_layer, 2);
  const PileScenario alike = join("{ layers = 3, pieces_per_layer = 7 }, { layers = 3, pieces_per_layer = 4 }");
  EXPECT_EQ(alike.layers, 3);
  EXPECT_EQ(alike.pieces_per_layer, 11);
  const PileScenario idle = join("{ layers = 3, pieces_per_layer = 0 }, { layers = 2, pieces_per_layer = 5 }");
  EXPECT_EQ(idle.layers, 2) << "the other part drops nothing";
  EXPECT_EQ(idle.pieces_per_layer, 5);
}

TEST(JoinedPiles, WhatFallsHasTheDefaultsOfAMission) {
  const PileScenario pile = join("{ placed = {}, mix = { { asset = 'brick' } } }, rubble.building {}");
  EXPECT_EQ(pile.layers, 4);
  EXPECT_EQ(pile.pieces_per_layer, 300);
  EXPECT_EQ(pile.spawn_bounds.x, 10);
  EXPECT_EQ(join("{ placed = {} }, rubble.building {}").layers, 0);
}

TEST(JoinedPiles, RefuseWhatCannotBeJoined) {
  const auto error = [](const std::string& parts) { return mission_error("return {\n pile = rubble.join(" + parts + ") }"); };
  EXPECT_EQ(error("rubble.building {}, {}, rubble.building {}"),
            "m.lua:2: rubble.join: parts 1 and 3 both have a building: a pile has one at most");
  EXPECT_EQ(error("{}, { layres = 2 }"),
            "m.lua:2: rubble.join: part 2 has the key \"layres\", which no pile has, or which it cannot join");
  EXPECT_EQ(error("{}, 5"), "m.lua:2: rubble.join: part 2 is no pile but a number");
  const std::string ground = "{ terrain = rubble.terrain.from(function() return 1 end) }";
  EXPECT_EQ(error(ground + ", " + ground),
            "m.lua:2: rubble.join: parts 1 and 2 both have a terrain: a pile has one at most");
  const std::string fine = "{ layers = 1, spawn_density = rubble.density.from(function() return 1 end, { columns = 200 }) }";
  EXPECT_NE(error(fine + ", { layers = 1 }").find("100 x 100 at most"), std::string::npos);
  EXPECT_EQ(error(fine + ", rubble.building {}"), "");
  EXPECT_EQ(error("{ layers = 1, pieces_per_layer = 1 }, { layers = 2, pieces_per_layer = 5 }"),
            "m.lua:2: rubble.join: 11 pieces (1 x 1, 2 x 5) do not fill 2 layers evenly: give all parts the same number of `layers`");
  EXPECT_EQ(error("{ layers = 0 / 0 - 1 }").find("m.lua:2: rubble.join: part 1 has layers = "), 0u);
  EXPECT_EQ(error("{ pieces_per_layer = 2.5 }"),
            "m.lua:2: rubble.join: part 1 has pieces_per_layer = 2.5: expected a whole number from 0 to 100000");
  EXPECT_EQ(error("{ layers = 1, spawn_bounds = { 1, 2 } }"),
            "m.lua:2: rubble.join: the spawn_bounds of part 1 is not three numbers {x, y, z} above 0");
  EXPECT_EQ(error("{}, { placed = { box = { 1, 1, 1 } } }"),
            "m.lua:2: rubble.join: the `placed` of part 2 has the key box: expected a list of pieces {{...}, {...}}");
}

PlacedItem placed(const std::string& piece) {
  return load_mission_text("return { pile = { layers = 0, placed = { " + piece + " } } }", "m.lua").scenario.pile.placed.at(0);
}

std::string piece_error(const std::string& piece) {
  return mission_error("return { pile = { layers = 0, placed = { " + piece + " } } }");
}

TEST(PlacedBoxes, TakeWhatABoxHas) {
  const PlacedItem wall = placed("rubble.wall { x0 = 0, x1 = 1, width = 2, height = 3, material = 'brick', fixed = false, broken = { '+z' } }");
  EXPECT_EQ(*wall.box, Vec3(1, 2, 3));
  EXPECT_EQ(wall.position, Vec3(0.5, 0, 1.5));
  EXPECT_EQ(wall.material, "brick");
  EXPECT_EQ(wall.broken, std::vector<std::string>{"+z"});
  EXPECT_FALSE(wall.fixed);
  const PlacedItem plain = placed("rubble.wall { x0 = 0, x1 = 1, width = 2, height = 3 }");
  EXPECT_EQ(plain.material, PlacedItem().material);
  EXPECT_TRUE(plain.fixed);
  for (const char* from : {"{0, 0, 1}", "{x = 0, y = 0, z = 1}", "rubble.vec(0, 0, 1)"}) {
    const PlacedItem slab = placed("rubble.slab { from = " + std::string(from) + ", size = rubble.vec(4, 2, 0.5), material = 'timber' }");
    EXPECT_EQ(slab.position, Vec3(2, 0, 1.25)) << from;
    EXPECT_EQ(*slab.box, Vec3(4, 2, 0.5));
    EXPECT_EQ(slab.material, "timber");
  }
}

TEST(PlacedBoxes, RefuseEverythingElse) {
  const auto expect_in = [](const char* words, const std::string& piece) {
    const std::string error = piece_error(piece);
    EXPECT_NE(error.find(words), std::string::npos) << piece << "\n" << error;
  };
  const std::string wall = "rubble.wall { x0 = 0, x1 = 1, width = 2, height = 3, ", slab = "rubble.slab { size = {4, 2, 0.2}, ";
  expect_in("m.lua:1: rubble.wall.foo: unknown key `foo`", wall + "foo = 1 }");
  expect_in("rubble.wall.rpy_deg: unknown key", wall + "rpy_deg = {0, 0, 30} }");
  expect_in("rubble.wall.bottom: out of range", wall + "bottom = 0 / 0 }");
  expect_in("rubble.wall.height: out of range: expected more than `bottom`, found 3", wall + "bottom = 3 }");
  expect_in("did you mean `height`?", "rubble.wall { x0 = 0, x1 = 1, width = 2, heigth = 3 }");
  expect_in("rubble.wall.height: missing: expected a number, found nothing", "rubble.wall { x0 = 0, x1 = 1, width = 2, heigth = 3 }");
  expect_in("rubble.wall.x1: out of range: expected more than `x0`", "rubble.wall { x0 = 2, x1 = 1, width = 2, height = 3 }");
  expect_in("rubble.slab.from: missing: expected three numbers {x, y, z}, found nothing", slab + "}");
  for (const char* key : {"position", "rpy_deg"})
    expect_in("unknown key", slab + "from = {0, 0, 1}, " + key + " = {9, 9, 9} }");
  expect_in("rubble.slab.scale: unknown key", slab + "from = {0, 0, 1}, scale = 2 }");
  expect_in("rubble.slab.from: wrong type: expected three numbers", slab + "from = {0, 1} }");
  expect_in("rubble.slab.pitch_deg: out of range", slab + "from = {0, 0, 1}, pitch_deg = 0 / 0 }");
  expect_in("rubble.slab: wrong type: expected a table, found 5", "rubble.slab(5)");
  expect_in("rubble.slab.size: missing", "rubble.slab()");
}

TEST(CollapseErrors, WhatIsNoTable) {
  EXPECT_EQ(mission_error("return { pile = rubble.building(5) }"),
            "m.lua:1: rubble.building: wrong type: expected a table, found 5 (write rubble.building{ ... })");
  EXPECT_NE(mission_error("return { robots = { rubble.robot.snake('x') } }").find(
                "m.lua:1: rubble.robot.snake: wrong type: expected a table, found the string \"x\""), std::string::npos);
  EXPECT_NE(mission_error("return { pile = rubble.collapse.free { pieces = { box = {1, 1, 1} } } }")
                .find("rubble.collapse.free.pieces: out of range: expected a list of pieces"), std::string::npos);
}

}  // namespace collapse_errors_test
}  // namespace rubble
