#include "scripting/mission.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "tests/scripting/test_support.h"

namespace rubble {
namespace mission_test {

TEST(Mission, EmptyOneHasEveryDefault) {
  const Mission mission = load_text("return rubble.mission {}");
  EXPECT_EQ(scenario_to_json(mission.scenario), scenario_to_json(Scenario{}));
  EXPECT_EQ(mission.script.path, "m.lua");
  EXPECT_EQ(mission.script.sha256,
            "301a0c9b414802bc8af340d4172f8147b86e6ff3fb2b0d5069cfd1ba252f5d6f");
}

TEST(Mission, PlainTableWillDo) { EXPECT_EQ(load_text("return { seed = 7 }").scenario.seed, 7u); }

TEST(Mission, SetsWhatItSaysAndNothingElse) {
  const Mission mission = load_text(R"(
    local pile = { layers = 2, spawn_bounds = {1, 2, 3}, spawn_position = {x = 4, y = 5, z = 6} }
    pile.mix = { { asset = "brick", weight = 0.5, scale = {0.5, 2} }, { asset = "slab", scale = 3 } }
    return rubble.mission {
      pile = pile,
      settle = { schedule = "planes" },
      camera = { width = 64.0, fov_deg = 60 },
      trajectory = { waypoints = { { position = {1, 0, 0}, look_at = {0, 0, 0} } } },
      packs = { "a", "b" },
    })");
  const Scenario& s = mission.scenario;
  EXPECT_EQ(s.pile.layers, 2);
  EXPECT_EQ(s.pile.spawn_bounds, Vec3(1, 2, 3));
  EXPECT_EQ(s.pile.spawn_position, Vec3(4, 5, 6));
  ASSERT_EQ(s.pile.mix.size(), 2u);
  EXPECT_EQ(s.pile.mix[0].asset, "brick");
  EXPECT_EQ(s.pile.mix[0].weight, 0.5);
  EXPECT_EQ(s.pile.mix[0].scale, (std::array<double, 2>{0.5, 2}));
  EXPECT_EQ(s.pile.mix[1].weight, 1);
  EXPECT_EQ(s.pile.mix[1].scale, (std::array<double, 2>{3, 3}));
  EXPECT_EQ(s.settle.schedule, Schedule::planes);
  EXPECT_EQ(s.cameras[0].camera.width, 64);
  EXPECT_EQ(s.cameras[0].camera.height, 1024);
  EXPECT_EQ(s.packs, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(pack_folders(mission), (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(s.trajectory.waypoints.size(), 1u);
  EXPECT_EQ(s.trajectory.waypoints[0].look_at, Vec3(0, 0, 0));
}

// A group with a switch takes it alone; others do not.
TEST(Mission, AGroupIsSwitchedOnByItsName) {
  const Scenario s = load_text("return rubble.mission { imu = true, lamp = false }").scenario;
  EXPECT_EQ(s.imus.size(), 1u);
  EXPECT_FALSE(s.lamp.on);
  EXPECT_TRUE(load_text("return rubble.mission { imu = { rate_hz = 100 } }").scenario.imus.empty());
  const auto watches = [](const std::string& words) {
    return load_text("return rubble.mission { record_settling = " + words + " }")
        .scenario.record_settling.on;
  };
  EXPECT_TRUE(watches("{ rate_hz = 5 }"));
  EXPECT_TRUE(watches("{}"));
  EXPECT_FALSE(watches("{ on = false, rate_hz = 5 }"));
  EXPECT_TRUE(load_text("return rubble.mission {}", with_overrides({"record_settling=true"}))
                  .scenario.record_settling.on);
  EXPECT_EQ(mission_error("return rubble.mission {\n pile = true }"),
            "m.lua:2: pile: wrong type: expected a table, found true");
  EXPECT_EQ(mission_error("return rubble.mission {\n imu = 3 }"),
            "m.lua:2: imu: wrong type: expected a table, found 3");
}

// Every kind of mistake, all of them in one run, sorted by line.
TEST(MissionErrors, AllAtOnceWithLines) {
  EXPECT_EQ(mission_error(R"(local pile = { layers = 2, pieces_per_layre = 5 }
return rubble.mission {
  seed = "x",
  pile = pile,
  lamps = {},
  camera = { width = 5,
    height = 100, width = 64,
    fov_deg = 500 },
  settle = { schedule = "plane" },
  air = 3,
  light = { position = {1, 2}, rpy_deg = {1, "a", 3}, intensity = "bright" },
  trajectory = { waypoints = { { position = {0, 0, 1} },
    { t = -1 } } },
  outputs = { bag = "yes" },
  packs = "concrete",
})"),
            "m.lua:1: pile.pieces_per_layre: unknown key `pieces_per_layre` "
            "(did you mean `pieces_per_layer`?)\n"
            "m.lua:3: seed: wrong type: expected an integer of at least 0, found the string \"x\"\n"
            "m.lua:5: lamps: unknown key `lamps` (did you mean `lamp`?)\n"
            "m.lua:7: camera.width: written twice (first on line 6)\n"
            "m.lua:8: camera.fov_deg: out of range: expected a number from 1 to 360, found 500\n"
            "m.lua:9: settle.schedule: unknown choice: expected one of \"layers\", \"planes\", "
            "found the string \"plane\" (did you mean \"planes\"?)\n"
            "m.lua:10: air: wrong type: expected a table, found 3\n"
            "m.lua:11: light.intensity: wrong type: expected a number from 0 to 1000, found the "
            "string \"bright\"\n"
            "m.lua:11: light.position: wrong type: expected three numbers {x, y, z}, each from "
            "-1000 to 1000, found {1, 2}\n"
            "m.lua:11: light.rpy_deg: wrong type: expected three numbers {x, y, z}, each from -360 "
            "to 360, found {1, the string \"a\", 3}\n"
            "m.lua:13: trajectory.waypoints[2].t: out of range: expected a number from 0 to 86400, "
            "found -1\n"
            "m.lua:13: trajectory.waypoints[2].position: missing: expected three numbers {x, y, "
            "z}, each from -1000 to 1000, or a place in a void, found nothing\n"
            "m.lua:14: outputs.bag: wrong type: expected true or false, found the string \"yes\"\n"
            "m.lua:15: packs: wrong type: expected a list of strings, found the string "
            "\"concrete\"");
}

TEST(MissionErrors, AnItemOfALongListIsNamed) {
  const auto error = [](const std::string& items) {
    return mission_error("return rubble.mission { pile = { terrain = { columns = 3, rows = 2, heights = {" + items + "} } } }");
  };
  EXPECT_NE(error("0, 0, 0, 0, 2000, 0").find("pile.terrain.heights: out of range: expected a list of numbers, each from -1000 to 1000, "
                                              "found 2000 as item 5 of 6"), std::string::npos);
  EXPECT_NE(error("0, 0, 'a', 0, 0, 0").find("wrong type: expected a list of numbers, each from -1000 to 1000, found the string \"a\" "
                                             "as item 3 of 6"), std::string::npos);
}

TEST(MissionErrors, UnknownKeyFarFromAllNamesListsThem) {
  const std::string start =
      "m.lua:2: camera.zzzzz: unknown key `zzzzz`: expected one of width, height, fov_deg";
  EXPECT_EQ(mission_error("return rubble.mission {\n  camera = { zzzzz = 1 },\n}")
                .substr(0, start.size()),
            start);
}

TEST(MissionErrors, UnknownChannel) {
  EXPECT_EQ(mission_error("return rubble.mission {\n  camera = { channels = { 'flow', 'norm' } },\n}"),
            "m.lua:2: camera.channels[2]: unknown channel `norm`: expected one of normals, instance, "
            "label, flow, sky_visibility, position");
  EXPECT_EQ(mission_error("return rubble.mission {\n  camera = { channels = { 'normal' } },\n}"),
            "m.lua:2: camera.channels[1]: unknown channel `normal` (did you mean `normals`?)");
}

TEST(MissionErrors, ListsAndTablesMixedUp) {
  EXPECT_EQ(mission_error("return rubble.mission {\n 5,\n pile = { mix = { asset = 'a' } },\n"
                          "camera = { 640, 480 }, trajectory = { waypoints = { 7 } } }"),
            "m.lua:2: [1]: a value without a name: expected named fields, found 5 "
            "(write `name = value`)\n"
            "m.lua:3: pile.mix: wrong type: expected a list of tables, found a table of named "
            "fields (write {{...}, {...}})\n"
            "m.lua:4: camera[1]: a value without a name: expected named fields, found 640 "
            "(write `name = value`)\n"
            "m.lua:4: trajectory.waypoints[1]: wrong type: expected a table, found 7");
}

TEST(MissionErrors, WhatContradictsItself) {
  EXPECT_EQ(
      mission_error(R"(return rubble.mission {
  pile = { mix = { { asset = "a", weight = 0 } }, placed = { { asset = "" , position = {0, 0, 0} } } },
  trajectory = { waypoints = {
    { position = {0, 0, 0}, t = 1 },
    { position = {1, 0, 0}, t = 2, speed = 3 },
    { position = {1, 0, 0}, t = 2, look_at = {1, 0, 0} },
    { position = {1, 0, 0}, look_at = {2, 0, 0}, rpy_deg = {5, 6, 7} } } } })"),
      "m.lua:2: pile.placed[1]: no piece: expected `asset = NAME` or `box = {x, y, z}`, found "
      "neither\n"
      "m.lua:2: pile.mix: all weights are 0: expected a weight above 0, found only weights of "
      "0\n"
      "m.lua:4: trajectory.waypoints[1].t: the first waypoint is the start: expected 0, found "
      "1\n"
      "m.lua:5: trajectory.waypoints[2].speed: contradicts t: expected one of t and speed, "
      "found both\n"
      "m.lua:6: trajectory.waypoints[3].look_at: nothing to look at: expected a point away "
      "from the camera, found the camera's own position\n"
      "m.lua:6: trajectory.waypoints[3].t: times do not increase: expected a time after 2 s, "
      "found 2\n"
      "m.lua:7: trajectory.waypoints[4].rpy_deg: contradicts look_at: expected {roll, 0, 0} "
      "beside look_at, found a pitch or a yaw (keep one of the two)\n"
      "m.lua:7: trajectory.waypoints[4]: no time passes: expected a `t` where the camera "
      "stays in place, found the position of the waypoint before");
}

TEST(MissionErrors, SyntaxAndRuntimeHaveTheirLine) {
  EXPECT_EQ(mission_error("return rubble.mission {\n  seed = = 2\n}"),
            "m.lua:2: unexpected symbol near '='");
  EXPECT_EQ(mission_error("local a = nil\nlocal b = a.x\n"),
            "m.lua:2: attempt to index a nil value (local 'a')");
  EXPECT_EQ(mission_error("error('my own words')"), "m.lua:1: my own words");
  EXPECT_EQ(mission_error(""),
            "m.lua: the script does not return a mission: expected return rubble.mission { ... }, "
            "found nothing");
  EXPECT_EQ(mission_error("\nreturn rubble.mission(5)"),
            "m.lua:2: the script does not return a mission: expected return rubble.mission { ... "
            "}, found 5");
}

TEST(MissionErrors, NoSuchFile) {
  EXPECT_EQ(error_of([] { load_mission("/nowhere/m.lua"); }), "/nowhere/m.lua: no such file");
  EXPECT_EQ(error_of([] { load_mission("/"); }), "/: is a folder: expected a Lua script");
  const auto given = [](const std::string& text) {
    const std::string path = ::testing::TempDir() + "rubble_no_script_" + std::to_string(getpid());
    std::ofstream(path, std::ios::binary) << text;
    const std::string error = error_of([&] { load_mission(path); });
    std::remove(path.c_str());
    return error.substr(std::min(error.size(), path.size()));
  };
  EXPECT_EQ(given("\xef\xbb\xbf<?xml version=\"1.0\"?><robot/>").rfind(": is no Lua script: expected a Lua script, found XML", 0), 0u);
  EXPECT_EQ(given("{ \"version\": 1 }").rfind(": is no Lua script: expected a Lua script, found JSON (`rubble remake`", 0), 0u);
  EXPECT_EQ(given(std::string("glTF\0\2", 6)).rfind(": is no Lua script: expected a Lua script, found a file of bytes", 0), 0u);
}

TEST(MissionOverrides, AreParsedByTheKeysType) {
  const Scenario s = load_text("return rubble.mission { seed = 1 }",
                               with_overrides({"pile.layers=3", "lamp.on=false",
                                               "camera.fov_deg=60", "light.position=1,2,3",
                                               "light.type=spot", "pile.spawn_bounds={4, 5, 6}",
                                               "packs=x,y", "trajectory.waypoints[1].look_at=0,0,1",
                                               "pile.spawn_position.x=7", "seed=12"}))
                         .scenario;
  EXPECT_EQ(s.pile.layers, 3);
  EXPECT_FALSE(s.lamp.on);
  EXPECT_EQ(s.cameras[0].camera.fov_deg, 60);
  EXPECT_EQ(s.lights[0].spec.position, Vec3(1, 2, 3));
  EXPECT_EQ(s.lights[0].spec.type, LightType::spot);
  EXPECT_EQ(s.pile.spawn_bounds, Vec3(4, 5, 6));
  EXPECT_EQ(s.packs, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(s.trajectory.waypoints[0].look_at, Vec3(0, 0, 1));
  EXPECT_EQ(s.pile.spawn_position, Vec3(7, 0, 4.5));
  EXPECT_EQ(s.seed, 12u);
}

// A shell hands on the quotation marks of {"concrete"}.
TEST(MissionOverrides, WordsMayHaveQuotationMarks) {
  const auto set = [](const std::vector<std::string>& settings) {
    return load_text("return rubble.mission { seed = 1 }", with_overrides(settings)).scenario;
  };
  const std::vector<std::string> two{"a, b", "c"};
  EXPECT_EQ(set({"packs={\"a, b\", 'c'}"}).packs, two);
  EXPECT_EQ(set({"packs='a, b',c"}).packs, two);
  EXPECT_EQ(set({"packs={it's, 5\"}"}).packs, (std::vector<std::string>{"it's", "5\""}));
  EXPECT_EQ(set({"light.type=\"spot\""}).lights[0].spec.type, LightType::spot);
  EXPECT_EQ(set({"camera.topic='/front'"}).cameras[0].topic(), "/front");
  EXPECT_THROW(set({"pile.layers=\"3\""}), InputError);
}

TEST(MissionOverrides, MistakesNameSet) {
  EXPECT_EQ(
      mission_error("return rubble.mission { seed = 1 }",
                    with_overrides({"pile.layres=3", "camera.width=a", "camera.width=5", "width=64",
                                    "zzz=1", "pile", "trajectory.waypoints[9].t=1", "pile.mix=a", "robots.2.position=1,0,0"})),
      "--set: pile.layres: unknown key `pile.layres` (did you mean `pile.layers`?)\n"
      "--set: camera.width: wrong type: expected an integer from 16 to 8192, found the "
      "string \"a\"\n"
      "--set: camera.width: out of range: expected an integer from 16 to 8192, found 5\n"
      "--set: not an assignment: expected KEY=VALUE, found \"pile\"\n"
      "--set: trajectory.waypoints[9].t: no such item: the list has 1\n"
      "--set: pile.mix: not a single value: expected a script for lists and tables\n"
      "--set: robots.2.position: unknown key `robots.2.position` (did you mean `robots[2].position`?)\n"
      // What a parameter of the script might have been, at its end.
      "--set: width: unknown key `width` (did you mean `camera.width`?)\n"
      "--set: zzz: unknown key `zzz` (`rubble check` prints every key)");
}

// The published simulator's parameters, each against the member that it means.
TEST(MissionAliases, PublishedNamesInLuaAndSet) {
  const char* const kLua = R"(return rubble.mission {
    spawnposx = 1, spawnposy = 2, spawnposz = 3, spawnboundx = 4, spawnboundy = 5, spawnboundz = 6,
    numlayers = 7, numobjs = 8, setlightrot = false, lighttype = "point", lightintensity = 9,
    lightrotx = 10, lightroty = 11, lightrotz = 12, lightposx = 13, lightposy = 14, lightposz = 15,
    fogdensity = 0.5, fogintensity = 0.25, randomseed = 16, exportstl = false })";
  const MissionOptions set = with_overrides(
      {"spawnposx=1",      "spawnposy=2",  "spawnposz=3",   "spawnboundx=4",     "spawnboundy=5",
       "spawnboundz=6",    "numlayers=7",  "numobjs=8",     "setlightrot=false", "lighttype=point",
       "lightintensity=9", "lightrotx=10", "lightroty=11",  "lightrotz=12",      "lightposx=13",
       "lightposy=14",     "lightposz=15", "fogdensity=.5", "fogintensity=0.25", "randomseed=16",
       "exportstl=false"});
  const Scenario a = load_text(kLua).scenario;
  const Scenario b = load_text("return {}", set).scenario;
  EXPECT_EQ(scenario_to_json(a), scenario_to_json(b));
  EXPECT_EQ(a.pile.spawn_position, Vec3(1, 2, 3));
  EXPECT_EQ(a.pile.spawn_bounds, Vec3(4, 5, 6));
  EXPECT_EQ(a.pile.layers, 7);
  EXPECT_EQ(a.pile.pieces_per_layer, 8);
  EXPECT_TRUE(a.lights[0].random_rotation);
  EXPECT_EQ(a.lights[0].spec.type, LightType::point);
  EXPECT_EQ(a.lights[0].spec.intensity, 9);
  EXPECT_EQ(a.lights[0].spec.rpy_deg, Vec3(10, 11, 12));
  EXPECT_EQ(a.lights[0].spec.position, Vec3(13, 14, 15));
  EXPECT_EQ(a.air.fog_density, 0.5);
  EXPECT_EQ(a.air.fog_intensity, 0.25);
  EXPECT_EQ(a.seed, 16u);
  EXPECT_FALSE(a.outputs.stl);
  EXPECT_FALSE(load_text("return { setlightrot = true }").scenario.lights[0].random_rotation);
}

TEST(MissionAliases, MistakesInThem) {
  EXPECT_EQ(mission_error("return rubble.mission {\n  numlayers = -1,\n  numobj = 3,\n"
                          "  seed = 1, randomseed = 2,\n  lighttype = 'moon' }"),
            "m.lua:2: numlayers: out of range: expected an integer from 0 to 1000, found -1\n"
            "m.lua:3: numobj: unknown key `numobj` (did you mean `numobjs`?)\n"
            "m.lua:4: randomseed: given twice (it is another name of `seed`: keep one of them)\n"
            "m.lua:5: lighttype: unknown choice: expected one of \"directional\", \"spot\", "
            "\"point\", \"sun\", found the string \"moon\"");
  EXPECT_EQ(mission_error("return { pile = { numlayers = 3 } }"),
            "m.lua:1: pile.numlayers: unknown key `numlayers` (did you mean `layers`?)");
}

TEST(MissionSeed, CommandLineWins) {
  MissionOptions options = with_overrides({"seed=5"});
  options.seed = 9;
  EXPECT_EQ(load_text("return { seed = 1 }", options).scenario.seed, 9u);
}

TEST(MissionSeed, StreamsFollowIt) {
  const char* const kScript = R"(
    local r = rubble.random("a")
    return rubble.mission { seed = 1, pile = { layers = r:integer(0, 1000),
                                               pieces_per_layer = r:integer(0, 100000) } })";
  MissionOptions other;
  other.seed = 2;
  const auto json = [&](const MissionOptions& o) {
    return scenario_to_json(load_text(kScript, o).scenario);
  };
  EXPECT_EQ(json({}), json({}));
  EXPECT_EQ(json(other), json(with_overrides({"seed=2"})));
  const Scenario a = load_text(kScript).scenario, b = load_text(kScript, other).scenario;
  EXPECT_NE(a.pile.pieces_per_layer, b.pile.pieces_per_layer);
}

TEST(MissionSeed, MustBeKnownBeforeItIsUsed) {
  EXPECT_EQ(mission_error("local s = 3\nlocal x = math.random()\nreturn rubble.mission {\n"
                          "  seed = s + 1 }"),
            "m.lua:4: seed: random numbers were drawn before the seed was known: expected a plain "
            "number in the mission's table (or give it with --seed)");
  EXPECT_EQ(mission_error("return rubble.mission { seed = 1 + 1 }"), "");
}

TEST(MissionAssets, UnknownOnesAreAllNamed) {
  const Mission mission = load_text(R"(return rubble.mission { pile = {
    mix = { { asset = "brick" },
            { asset = "slap" } },
    placed = { { asset = "zzzzzzzz", position = {0, 0, 0} } } } })");
  EXPECT_EQ(error_of([&] {
              check_assets(mission, {"brick", "slab"});
            }),
            "m.lua:3: pile.mix[2].asset: unknown asset `slap` (did you mean `slab`?)\n"
            "m.lua:4: pile.placed[1].asset: unknown asset `zzzzzzzz` (the packs have 2 assets)");
  EXPECT_EQ(error_of([&] { check_assets(mission, {"brick", "slap", "zzzzzzzz"}); }), "");
}

TEST(MissionAssets, FurnitureIsNamedLikePiecesAndNeedsABuilding) {
  const Mission mission = load_text(R"(return rubble.mission { pile = { building = { storeys = 2,
    furniture = { { asset = "sofa" },
                  { asset = "sofas", per_bay = 2, roof = true } } } } })");
  ASSERT_EQ(mission.scenario.pile.furniture.size(), 2u);
  EXPECT_EQ(mission.scenario.pile.furniture[1].per_bay, 2);
  EXPECT_EQ(error_of([&] { check_assets(mission, {"sofa"}); }),
            "m.lua:3: pile.building.furniture[2].asset: unknown asset `sofas` (did you mean `sofa`?)");
  EXPECT_EQ(error_of([] {
              load_text(R"(return rubble.mission { pile = { building = {
    furniture = { { asset = "sofa" } } } } })");
            }),
            "m.lua:2: pile.building.furniture: no building: expected pile.building.storeys above 0, found 0 "
            "(rubble.building{ furniture = {...} } makes one of four storeys)");
}

}  // namespace mission_test
}  // namespace rubble
