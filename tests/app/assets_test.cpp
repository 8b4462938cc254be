// `rubble assets`: the bundled packs pass, and packs with mistakes do not.
#include <gtest/gtest.h>

#include "tests/app/own_pack.h"

namespace rubble::testing {
namespace assets_test {

using Json = nlohmann::json;

class BundledPack : public ::testing::TestWithParam<std::string> {};

TEST_P(BundledPack, PassesItsCheck) {
  const Json report = check_json(GetParam());
  EXPECT_EQ(report.at("pack"), GetParam());
  for (const Json& asset : report.at("assets")) {
    const std::string name = asset.at("name");
    EXPECT_TRUE(asset.at("closed")) << name;
    EXPECT_TRUE(asset.at("errors").empty()) << name << ": " << asset.at("errors");
    EXPECT_TRUE(asset.at("warnings").empty()) << name << ": " << asset.at("warnings");
    EXPECT_GE(asset.at("thinnest_m"), 0.01) << name;
    EXPECT_LE(asset.at("most_corners"), 32) << name;
    EXPECT_GT(asset.at("mass_kg"), 0.5) << name;
    EXPECT_LT(asset.at("mass_kg"), 8000) << name;
  }
  for (const Json& tree : report.at("articulated")) {
    EXPECT_TRUE(tree.at("errors").empty()) << tree.at("name") << ": " << tree.at("errors");
    EXPECT_TRUE(tree.at("warnings").empty()) << tree.at("name") << ": " << tree.at("warnings");
    EXPECT_EQ(tree.at("joints").get<int>(), tree.at("links").get<int>() - 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Assets, BundledPack,
                         ::testing::Values("concrete", "residential", "parking", "bridge", "victims"),
                         [](const auto& test) { return test.param; });

TEST(AssetsCheck, MeasuresACubeAgainstItsParts) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(1));
  // A part that is a quarter of the cube: a quarter is covered, three quarters are not.
  write_file(scratch / "part.obj",
             "o a\nv 0 0 0\nv 0.5 0 0\nv 0 0.5 0\nv 0.5 0.5 0\nv 0 0 1\nv 0.5 0 1\nv 0 0.5 1\n"
             "v 0.5 0.5 1\nf 1 3 4\nf 1 2 6\nf 2 4 8\nf 4 3 7\nf 3 1 5\nf 5 6 8\n");
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\", material = \"timber\""));
  const Json whole = check_json(scratch.path().string()).at("assets")[0];
  EXPECT_NEAR(whole.at("volume_m3"), 1, 1e-6);
  EXPECT_NEAR(whole.at("mass_kg"), 500, 1e-3);
  EXPECT_NEAR(whole.at("parts_outside_mesh_m3"), 0, 1e-5);
  EXPECT_NEAR(whole.at("mesh_outside_parts_m3"), 0, 1e-5);
  write_file(scratch / "pack.lua", one_asset("collision = { parts = \"part.obj\" }"));
  const Json quarter = check_json(scratch.path().string()).at("assets")[0];
  EXPECT_NEAR(quarter.at("parts_outside_mesh_m3"), 0, 1e-5);
  EXPECT_NEAR(quarter.at("mesh_outside_parts_m3"), 0.75, 0.01);
  EXPECT_FALSE(quarter.at("warnings").empty());
}

TEST(AssetsCheck, SaysThatAnOpenMeshHasNoVolumeOfItsOwn) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(1, true));
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Json cube = check_json(scratch.path().string()).at("assets")[0];
  EXPECT_FALSE(cube.at("closed"));
  EXPECT_NEAR(cube.at("volume_m3"), 1, 1e-5) << "of the hull";
  ASSERT_EQ(cube.at("warnings").size(), 1u);
  EXPECT_NE(cube.at("warnings")[0].get<std::string>().find("not closed"), std::string::npos);
}

// Two cubes on a third: joined ones may overlap, the two that are not must be apart.
std::string two_on_one(double apart, double joint_z) {
  const auto link = [&](const char* name, double x) {
    return std::string("{ asset = \"cube\", name = \"") + name + "\", on = \"base\", position = { " +
           std::to_string(x) + ", 0, 1 }, joint_position = { 0.5, 0.5, " + std::to_string(joint_z) +
           " } }, ";
  };
  return "return pack { name = \"own\", assets = { { name = \"cube\", mesh = \"cube.obj\", material = "
         "\"timber\" },\n{ name = \"tree\", links = { { asset = \"cube\", name = \"base\" }, " +
         link("a", 0) + link("b", apart) + "} } } }\n";
}

TEST(AssetsCheck, LooksAtArticulatedAssetsWhole) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(1));
  write_file(scratch / "pack.lua", two_on_one(1.2, 1));
  const Json tree = check_json(scratch.path().string()).at("articulated")[0];
  EXPECT_EQ(tree.at("links"), 3);
  EXPECT_NEAR(tree.at("mass_kg"), 1500, 1e-2);
  EXPECT_NEAR(tree.at("size_m")[0], 2.2, 1e-5);
  EXPECT_NEAR(tree.at("size_m")[2], 2, 1e-5);
  EXPECT_TRUE(tree.at("errors").empty()) << tree;

  write_file(scratch / "pack.lua", two_on_one(0.7, 1));
  const Json overlap = check_json(scratch.path().string(), 1).at("articulated")[0];
  ASSERT_EQ(overlap.at("errors").size(), 1u);
  EXPECT_NE(overlap.at("errors")[0].get<std::string>().find("link 3 (cube) overlaps link 2 (cube)"),
            std::string::npos);

  write_file(scratch / "pack.lua", two_on_one(1.2, -0.5));
  const Json astray = check_json(scratch.path().string()).at("articulated")[0];
  EXPECT_FALSE(astray.at("warnings").empty()) << "the joint is 50 cm below the base";

  const Outcome show =
      run_rubble("assets show " + scratch.path().string() + " --out " + (scratch / "sheet.png"));
  EXPECT_EQ(show.exit_code, 0) << show.err;
}

TEST(AssetsCheck, FailsForDegenerateParts) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(1));
  write_file(scratch / "part.obj", "o flat\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  write_file(scratch / "pack.lua", one_asset("collision = { parts = \"part.obj\" }"));
  const Json cube = check_json(scratch.path().string(), 1).at("assets")[0];
  EXPECT_FALSE(cube.at("errors").empty());
  const Outcome table = run_rubble("assets check " + scratch.path().string());
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_NE(table.out.find("error: cube: "), std::string::npos) << table.out;
}

TEST(AssetsShow, DrawsEveryAssetOnASheet) {
  const ScratchFolder scratch;
  write_file(scratch / "cube.obj", cube_obj(0.4));
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Outcome show =
      run_rubble("assets show " + scratch.path().string() + " --out " + (scratch / "sheet.png"));
  ASSERT_EQ(show.exit_code, 0) << show.err;
  const std::string png = read_file(scratch / "sheet.png");
  ASSERT_GT(png.size(), 5000u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  const Outcome other = run_rubble("assets show " + scratch.path().string() + " --out " + (scratch / "sheet.bmp"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("expected a file that ends with .png, .jpg or .jpeg, found .bmp"), std::string::npos) << other.err;
}

TEST(Assets, AreFoundByTheNameOfABundledPack) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua",
             "return rubble.mission { packs = { \"parking\", \"bridge\" },\n"
             "  pile = { mix = { { asset = \"car_flat\" }, { asset = \"girder\" } } } }\n");
  EXPECT_EQ(run_rubble("check " + (scratch / "m.lua")).exit_code, 0);
  write_file(scratch / "m.lua", "return rubble.mission { packs = { \"parking_\" } }\n");
  const Outcome wrong = run_rubble("check " + (scratch / "m.lua"));
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.err.find("m.lua:1: packs[1]: unknown pack `parking_`: expected a bundled pack (bridge, concrete, "
                           "parking, residential, victims) or a folder with a pack.lua (did you mean `parking`?)"),
            std::string::npos)
      << wrong.err;
}

}  // namespace assets_test
}  // namespace rubble::testing
