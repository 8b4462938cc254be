#include "scripting/packs/asset_pack.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/scripting/script_files.h"

namespace rubble {
namespace asset_pack_test {

const std::vector<Material> kMaterials = {{"concrete", 2400, 0.8, "s"}, {"steel", 7850, 0.57, "s"}};

class AssetPackTest : public ScriptFiles {
 protected:
  void SetUp() override {
    ScriptFiles::SetUp();
    for (const char* name : {"a.obj", "a.lod1.obj", "a.parts.obj", "b.stl"}) write(name, "");
  }
  AssetPack load(const std::string& text) {
    write("pack.lua", text);
    return load_asset_pack(folder_.string(), kMaterials);
  }
  std::string error(const std::string& text) {
    return error_of([&] { load(text); });
  }
  std::string script() const { return (folder_ / "pack.lua").string(); }
};

TEST_F(AssetPackTest, EveryKey) {
  const AssetPack pack = load(R"(return pack {
  name = "mine",
  assets = {
    { name = "a", mesh = { "a.obj", "a.lod1.obj" }, units = "cm", up = "y",
      collision = { parts = "a.parts.obj" }, material = "steel", density = 7000,
      scale = { 0.7, 1.3 }, weight = 2, tags = { "bar", "metal" } },
    { name = "b", mesh = "b.stl", collision = "hull", material = "concrete" },
  },
})");
  EXPECT_EQ(pack.name, "mine");
  EXPECT_EQ(pack.folder, folder_.string());
  EXPECT_EQ(pack.script, script());
  ASSERT_EQ(pack.assets.size(), 2u);
  const Asset& a = pack.assets[0];
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.meshes, (std::vector<std::string>{(folder_ / "a.obj").string(),
                                                (folder_ / "a.lod1.obj").string()}));
  EXPECT_EQ(a.metres_per_unit, 0.01);
  EXPECT_EQ(a.up, UpAxis::y);
  EXPECT_EQ(a.parts, (folder_ / "a.parts.obj").string());
  EXPECT_EQ(a.material, "steel");
  EXPECT_EQ(a.density, 7000);
  EXPECT_EQ(a.friction, 0.57);
  EXPECT_EQ(a.scale, (std::array<double, 2>{0.7, 1.3}));
  EXPECT_EQ(a.weight, 2);
  EXPECT_EQ(a.tags, (std::vector<std::string>{"bar", "metal"}));
  EXPECT_EQ(a.line, 4);
  const Asset& b = pack.assets[1];
  EXPECT_EQ(b.metres_per_unit, 1);
  EXPECT_EQ(b.parts, "");
  EXPECT_EQ(b.density, 2400);
  EXPECT_EQ(b.friction, 0.8);
  EXPECT_EQ(b.scale, (std::array<double, 2>{1, 1}));
  EXPECT_EQ(b.line, 7);
}

// Names become names of files, of labels and of objects, and are printed.
TEST_F(AssetPackTest, NamesThatLeaveTheirFolderOrLineAreRefused) {
  for (const char* name : {"../../../outside", "a/b", "a\\\\b", "..", ".hidden", "a\\nb", "a\\27[2J", ""}) {
    const std::string text = error(std::string("return pack { name = \"x\", assets = { { name = \"") + name +
                                   "\", mesh = \"a.obj\", material = \"steel\" } } }");
    EXPECT_NE(text.find("assets[1].name: the name "), std::string::npos) << name << "\n" << text;
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
  }
  EXPECT_EQ(load("return pack { name = \"x\", assets = { { name = \"slab 2, broken\", mesh = \"a.obj\", material = \"steel\" } } }")
                .assets[0].name, "slab 2, broken");
}

TEST_F(AssetPackTest, ReadsArticulatedAssets) {
  const AssetPack pack = load(R"(return pack {
  name = "x",
  assets = {
    { name = "a", mesh = "a.obj", material = "concrete" },
    { name = "b", mesh = "b.stl", material = "steel" },
    { name = "gate", scale = {0.5, 2}, links = {
      { asset = "a" },
      { name = "leaf", asset = "b", on = "a", joint = "hinge", position = {1, 2, 3},
        rpy_deg = {0, 0, 90}, joint_position = {0.5, 0, 0}, joint_axis = {0, 2, 0},
        stiffness = 5, damping = 6, yield = 7, break_torque = 8, limit_deg = {-90, 45} },
      { name = "bolt", asset = "b", scale = 0.5, on = "leaf", joint = "slider",
        joint_axis = {0, 0, -1}, travel = 0.3, break_force = 9, collide = true },
      { name = "knob", asset = "a", on = "leaf", limit_deg = 60 },
    } },
  },
})");
  ASSERT_EQ(pack.assets.size(), 3u);
  const Asset& gate = pack.assets[2];
  EXPECT_TRUE(gate.meshes.empty());
  ASSERT_EQ(gate.links.size(), 4u);
  EXPECT_EQ(gate.links[0].on, -1);
  const AssetLink& leaf = gate.links[1];
  EXPECT_EQ(leaf.asset, "b");
  EXPECT_EQ(leaf.on, 0);
  EXPECT_EQ(leaf.joint.parent, 0);
  EXPECT_EQ(leaf.joint.child, 1);
  EXPECT_EQ(leaf.joint.kind, JointKind::hinge);
  EXPECT_EQ(leaf.whole_from_link.translation, (Vec3{1, 2, 3}));
  EXPECT_NEAR(leaf.whole_from_link.rotation.rotate({1, 0, 0}).y, 1, 1e-12);
  EXPECT_NEAR(leaf.joint.assembly_from_joint.rotation.rotate({0, 0, 1}).y, 1, 1e-12);
  EXPECT_EQ(leaf.joint.stiffness, 5);
  EXPECT_EQ(leaf.joint.damping, 6);
  EXPECT_EQ(leaf.joint.yield, 7);
  EXPECT_EQ(leaf.joint.break_torque, 8);
  EXPECT_EQ(leaf.joint.break_force, kNever);
  EXPECT_NEAR(leaf.joint.lower, -1.5707963, 1e-6);
  EXPECT_NEAR(leaf.joint.upper, 0.7853981, 1e-6);
  const AssetLink& bolt = gate.links[2];
  EXPECT_EQ(bolt.on, 1);
  EXPECT_NEAR(bolt.joint.assembly_from_joint.rotation.rotate({1, 0, 0}).z, -1, 1e-12);
  EXPECT_EQ(bolt.joint.lower, -0.3);
  EXPECT_EQ(bolt.joint.upper, 0.3);
  EXPECT_TRUE(bolt.joint.collide);
  EXPECT_EQ(gate.links[3].joint.kind, JointKind::ball);
  EXPECT_NEAR(gate.links[3].joint.upper, 1.0471975, 1e-6);
  EXPECT_EQ(gate.links[3].joint.yield, kNever);
}

TEST_F(AssetPackTest, NamesEveryMistakeOfLinks) {
  const std::string text = error(R"(return pack {
  name = "x",
  assets = {
    { name = "a", mesh = "a.obj", material = "concrete" },
    { name = "gate", links = {
      { asset = "a", on = "a" },
      { name = "leaf", asset = "nothing", on = "frame" },
      { name = "leaf", asset = "gate", on = "a", joint = "hinge", limit_deg = {5, 9} },
    } },
    { name = "one", mesh = "a.obj", links = { { asset = "a" } } },
    { name = "rope", links = { { asset = "a" }, { asset = "a", joint = "rope" } } },
    { name = "axis", links = { { asset = "a" },
      { name = "b", asset = "a", on = "a", joint_axis = {0, 0, 0} } } },
    { name = "list", links = { 5, "a" } },
  },
})");
  for (const char* part :
       {":6: assets[2].links[1].on: the first link hangs on nothing",
        ":7: assets[2].links[2].asset: no such piece: expected an asset of this pack that has a "
        "mesh, found \"nothing\"",
        ":7: assets[2].links[2].on: a link hangs on one that is listed before it: expected one of "
        "a, found \"frame\"",
        ":8: assets[2].links[3].name: two links have the name `leaf`",
        ":8: assets[2].links[3].asset: no such piece",
        ":8: assets[2].links[3].limit_deg: the designed pose is out of reach",
        ":10: assets[3].mesh: an asset has a mesh or links, not both",
        ":10: assets[3].links: wrong number of links: expected 2 to 256, found 1",
        ":11: assets[4].links[2].joint: unknown choice: expected one of \"weld\", \"hinge\", "
        "\"slider\", \"ball\", found the string \"rope\"",
        ":13: assets[5].links[2].joint_axis: no direction",
        ":14: assets[6].links[1]: wrong type: expected a table, found 5"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }
}

TEST_F(AssetPackTest, EveryMistakeInOneRun) {
  const std::string at = script() + ":";
  EXPECT_EQ(
      error(R"(return pack {
  nam = "x",
  assets = {
    { mesh = "a.obj" },
    { name = "b", mesh = "gone.obj", material = "steal" },
    { name = "c", mesh = 5, units = "inch", collision = "box" },
    { name = "b", mesh = "a.obj", material = "concrete", collision = { part = "a.parts.obj" } },
    { name = "b", mesh = "a.obj", material = "concrete", density = 0 },
    { name = "b", mesh = {}, material = "xyzzy" },
    { name = "d", mesh = "a.obj", material = "steel", collision = { parts = "no" }, wieght = 1 },
  },
})"),
      at + "1: name: missing: expected a string, found nothing\n" +                //
          at + "2: nam: unknown key `nam` (did you mean `name`?)\n" +              //
          at + "4: assets[1].name: missing: expected a string, found nothing\n" +  //
          at + "5: assets[2].mesh: no such file: expected a file in " + folder_.string() +
          ", found \"gone.obj\"\n" +  //
          at + "5: assets[2].material: unknown material `steal` (did you mean `steel`?)\n" + at +
          "6: assets[3].collision: unknown choice: expected \"hull\" or \"decompose\" or { parts = "
          "\"FILE\" }, found the string \"box\"\n" +  //
          at +
          "6: assets[3].mesh: wrong type: expected a string or a list of strings, found "
          "5\n" +  //
          at +
          "6: assets[3].units: unknown choice: expected one of \"m\", \"cm\", \"mm\", "
          "\"in\", \"ft\", found the string \"inch\"\n" +  //
          at +
          "7: assets[4].collision: wrong type: expected \"hull\" or \"decompose\" or { parts = \"FILE\" "
          "}, found a table of named fields\n" +  //
          at +
          "8: assets[5].density: out of range: expected a number from 10 to 25000, found "
          "0\n" +  //
          at +
          "9: assets[6].name: two assets have the name `b` (rename one of them)\n" + at +
          "9: assets[6].mesh: no mesh: expected at least one file, or links, found none\n" + at +
          "9: assets[6].material: unknown material `xyzzy`: expected one of concrete, "
          "steel\n" +  //
          at +
          "10: assets[7].wieght: unknown key `wieght` (did you mean `weight`?)");
}

TEST_F(AssetPackTest, NoFolderNoScriptNoAssets) {
  EXPECT_EQ(error_of([] { load_asset_pack("/nowhere", kMaterials); }),
            "/nowhere: no such folder: expected a folder with a pack.lua");
  EXPECT_EQ(error_of([&] { load_asset_pack(folder_.string(), kMaterials); }),
            script() + ": no such file");
  EXPECT_EQ(error("return pack { name = 'x', assets = {} }"),
            script() + ":1: assets: no assets: expected at least one, found an empty list");
  EXPECT_EQ(
      error("pack { name = 'x', assets = {} }"),
      script() +
          ":1: the script does not return a table: expected return pack { ... }, found nothing");
}

TEST_F(AssetPackTest, RunsInTheSandbox) {
  EXPECT_EQ(error("os.exit()").find(script() + ":1: attempt to index a nil value"), 0u);
  EXPECT_EQ(error("return pack {").find(script() + ":1: "), 0u);
}

TEST_F(AssetPackTest, SaysWhichKeysNothingReads) {
  const AssetPack pack = load(R"(return pack {
  name = "mine",
  assets = {
    { name = "a", mesh = "a.obj", material = "steel", scale = { 1, 2 }, typical = 1.5 },
    { name = "b", mesh = "b.stl", material = "steel", density = 900 },
    { name = "arm", density = 900, scale = { 1, 2 }, links = {
      { asset = "a", travel = 0.1 },
      { asset = "b", on = "a", joint = "hinge", travel = 0.1,
        limit_deg = 20, yield = 5, friction = 1 },
    } },
  },
})");
  const std::string at = script() + ":";
  ASSERT_EQ(pack.assets.size(), 3u);
  EXPECT_EQ(pack.assets[0].idle_keys,
            (std::vector<std::string>{at + "4: assets[1].typical: has no effect, because assets[1].spread is \"uniform\""}));
  EXPECT_TRUE(pack.assets[1].idle_keys.empty());
  EXPECT_EQ(pack.assets[2].idle_keys,
            (std::vector<std::string>{
                at + "6: assets[3].density: has no effect, because an asset with links is made of others, which have it",
                at + "7: assets[3].links[1].travel: has no effect, because the first link hangs on nothing",
                at + "8: assets[3].links[2].travel: has no effect, because only a slider has it",
                at + "9: assets[3].links[2].yield: has no effect, because assets[3].links[2].stiffness is 0"}));
}

TEST(Materials, TheBundledTable) {
  const auto materials = load_materials(RUBBLE_SOURCE_DIR "/assets/materials.lua");
  ASSERT_EQ(materials.size(), 10u);
  EXPECT_EQ(materials[0].name, "reinforced_concrete");
  EXPECT_EQ(materials[0].density, 2400);
  EXPECT_EQ(materials[0].friction, 0.8);
  EXPECT_EQ(materials[3].name, "steel");
  EXPECT_EQ(materials[3].density, 7850);
  for (const Material& m : materials) EXPECT_FALSE(m.source.empty()) << m.name;
}

TEST(Materials, MistakesHaveLines) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "materials_with_mistakes.lua";
  std::ofstream(path)
      << "return materials {\n  { name = 'a', density = 5, friction = 1, source = 's' "
         "},\n  { name = 'b', friction = 1, source = 's', colour = 1 },\n"
         "  { name = 'b', density = 50, friction = 1, source = 's',\n    name = 'b' "
         "},\n}\n";
  const std::string at = path.string() + ":";
  EXPECT_EQ(error_of([&] { load_materials(path.string()); }),
            at +
                "2: materials[1].density: out of range: expected a number from 10 to 25000, found "
                "5\n" +  //
                at +
                "3: materials[2].colour: unknown key `colour`: expected one of name, density, "
                "friction, look, source\n" +  //
                at +
                "3: materials[2].density: missing: expected a number from 10 to 25000, found "
                "nothing\n" +  //
                at +
                "5: materials[3].name: written twice (first on line 4)\n" +  //
                at + "5: materials[3].name: two materials have the name `b`");
  std::filesystem::remove(path);
}

}  // namespace asset_pack_test
}  // namespace rubble
