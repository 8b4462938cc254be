#include "scripting/sandbox/source_map.h"

#include <gtest/gtest.h>

#include "scripting/sandbox/lua_tokens.h"

namespace rubble {
namespace source_map_test {

SourceMap map_of(const std::string& text) { return SourceMap(text, "mission"); }

TEST(LuaTokens, LinesThroughCommentsAndStrings) {
  const auto tokens = read_lua_tokens(
      "#!shebang\na --[[ x\ny ]] b -- c\n[==[ d\n]] ]==] 'e\\\nf' 0x1p-3 1e+5 .5 a.b...c\n");
  std::string all;
  for (const LuaToken& t : tokens) all += std::to_string(t.line) + ":" + t.text + " ";
  EXPECT_EQ(all,
            "2:a 3:b 4:[==[ d\n]] ]==] 5:e\\\nf 6:0x1p-3 6:1e+5 6:.5 6:a 6:. 6:b 6:... 6:c 7: ");
}

TEST(LuaTokens, NeverFails) {
  for (const char* text : {"", "'", "\"\\", "[[", "--[[", "[=", "0x", "\xff\xfe", "a.", "'\\"})
    EXPECT_EQ(read_lua_tokens(text).back().kind, LuaToken::Kind::end) << text;
}

TEST(SourceMap, KeysOfOneConstructor) {
  const SourceMap map = map_of(R"(-- a comment with { in it
return rubble.mission {
  seed = 1, ["start_ns"] = 2;
  pile = {
    mix = {
      { asset = "a" },
      { asset = "b",
        weight = f { asset = 1 } },
      [4] = { asset = "}" },
    },
  },
  -- camera
  camera = { width = (function() local t = {}; t.x = 1, 2 return 5 end)(),
    height = 3 },
})");
  EXPECT_EQ(map.line_of("seed"), 3);
  EXPECT_EQ(map.line_of("start_ns"), 3);
  EXPECT_EQ(map.line_of("pile"), 4);
  EXPECT_EQ(map.line_of("pile.mix"), 5);
  EXPECT_EQ(map.line_of("pile.mix[1]"), 6);
  EXPECT_EQ(map.line_of("pile.mix[2].asset"), 7);
  EXPECT_EQ(map.line_of("pile.mix[2].weight"), 8);
  EXPECT_EQ(map.line_of("pile.mix[4].asset"), 9);
  EXPECT_EQ(map.line_of("camera.width"), 13);
  EXPECT_EQ(map.line_of("camera.height"), 14);
  EXPECT_EQ(map.line_of("pile.layers"), 4);  // not written: its table
  EXPECT_EQ(map.line_of("lamp.on"), 2);      // nothing of it: the call
  EXPECT_TRUE(map.duplicates().empty());
}

TEST(SourceMap, ThroughVariablesAndAssignments) {
  const SourceMap map = map_of(R"(local mix = {
  { asset = "a" } }
local pile = { layers = 3 }
pile.mix = mix
pile.spawn_bounds = {
  1, 2, 3 }
local m = rubble.mission { seed = 1,
  pile = pile }
m.camera = { width = 4,
  height = 5 }
m.camera.fov_deg =
  6
return m)");
  EXPECT_EQ(map.line_of("seed"), 7);
  EXPECT_EQ(map.line_of("pile.layers"), 3);
  EXPECT_EQ(map.line_of("pile.mix"), 4);
  EXPECT_EQ(map.line_of("pile.mix[1].asset"), 2);
  EXPECT_EQ(map.line_of("pile.spawn_bounds"), 5);
  EXPECT_EQ(map.line_of("camera.width"), 9);
  EXPECT_EQ(map.line_of("camera.height"), 10);
  EXPECT_EQ(map.line_of("camera.fov_deg"), 11);
}

TEST(SourceMap, ReturnedAndPassedVariables) {
  for (const char* end : {"return m", "return rubble.mission(m)", "return rubble.mission(m);"}) {
    const SourceMap map = map_of(std::string("local m = {\n seed = 1,\n}\nm.start_ns = 2\n") + end);
    EXPECT_EQ(map.line_of("seed"), 2) << end;
    EXPECT_EQ(map.line_of("start_ns"), 4) << end;
    EXPECT_EQ(map.line_of("lamp"), 1) << end;  // the table around it
  }
  EXPECT_EQ(map_of("return {\n seed = 1 }").line_of("seed"), 2);
  EXPECT_EQ(map_of("").line_of("seed"), 0);
}

TEST(SourceMap, VariablesInCircles) {
  const SourceMap map =
      map_of("local a = b\nlocal b = a\na = b\nreturn rubble.mission { pile = a }");
  EXPECT_EQ(map.line_of("pile.layers"), 4);
}

TEST(SourceMap, DuplicatesAndLiterals) {
  const SourceMap map = map_of(R"(return rubble.mission {
  seed = 5, pile = { layers = 1 },
  camera = { width = 1,
    width = 2 },
  randomseed = -7, start_ns = 5 + 1,
})");
  ASSERT_EQ(map.duplicates().size(), 1u);
  EXPECT_EQ(map.duplicates()[0].key, "camera.width");
  EXPECT_EQ(map.duplicates()[0].line, 4);
  EXPECT_EQ(map.duplicates()[0].first_line, 3);
  EXPECT_EQ(map.literal_of("seed"), 5);
  EXPECT_EQ(map.literal_of("pile.layers"), 1);
  EXPECT_EQ(map.literal_of("start_ns"), std::nullopt);
  EXPECT_EQ(map.literal_of("lamp"), std::nullopt);
}

TEST(SourceMap, DeepNestingIsNoTrouble) {
  const std::string deep = "return " + std::string(100000, '{') + std::string(100000, '}');
  EXPECT_EQ(map_of(deep).line_of("x"), 1);
}

}  // namespace source_map_test
}  // namespace rubble
