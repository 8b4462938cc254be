// A pack with colours of its own through a run: in pictures, in exports, and in the content that a manifest names.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/image/image_file.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace painted_pack_test {

// A block whose sides all have the image; its material is called as the test likes.
constexpr char kBlock[] = R"(mtllib block.mtl
v -0.4 -0.4 -0.4
v 0.4 -0.4 -0.4
v 0.4 0.4 -0.4
v -0.4 0.4 -0.4
v -0.4 -0.4 0.4
v 0.4 -0.4 0.4
v 0.4 0.4 0.4
v -0.4 0.4 0.4
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl side
f 4/1 3/2 2/3 1/4
f 5/1 6/2 7/3 8/4
f 1/1 2/2 6/3 5/4
f 2/1 3/2 7/3 6/4
f 3/1 4/2 8/3 7/4
f 4/1 1/2 5/3 8/4
)";

class PaintedPack : public ::testing::Test {
 protected:
  PaintedPack() {
    std::filesystem::create_directory(scratch_ / "pack");
    write_file(scratch_ / "pack/block.obj", kBlock);
    write_file(scratch_ / "pack/block.mtl", "newmtl side\nKd 1 1 1\nmap_Kd side.png\n");
    write_file(scratch_ / "pack/pack.lua",
               "return pack { name = 'p', assets = { { name = 'block', mesh = 'block.obj', material = 'timber' } } }\n");
    write_file(scratch_ / "m.lua", R"(return rubble.mission {
  seed = 3, packs = { "pack" },
  pile = { placed = { { asset = "block", position = { 0, 0, 0.4 }, fixed = true } }, layers = 0 },
  lamp = { on = false }, camera = { width = 96, height = 72 }, outputs = { frames = true },
  trajectory = { waypoints = { { position = { -2, -1, 1.2 }, look_at = { 0, 0, 0.4 } } } },
})");
    paint({200, 20, 20});
  }
  void paint(const std::array<std::uint8_t, 3>& colour) {
    RgbImage image{8, 8, {}};
    for (int i = 0; i < 64; ++i) image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
    write_png(scratch_ / "pack/side.png", image);
  }
  Outcome run(const std::string& arguments) { return run_rubble(arguments + " --quiet"); }
  // Share of pixels of a picture in which one channel is twice both others.
  double share(const std::string& folder, std::size_t channel) {
    const RgbImage image = read_rgb_png(scratch_ / (folder + "/frames/rgb/000000.png"));
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      const int own = image.rgb[i + channel];
      count += own > 2 * image.rgb[i + (channel + 1) % 3] && own > 2 * image.rgb[i + (channel + 2) % 3];
    }
    return double(count) / double(image.rgb.size() / 3);
  }

  const ScratchFolder scratch_;
};

TEST_F(PaintedPack, IsDrawnInItsColoursWhichArePartOfItsContent) {
  const std::string mission = scratch_ / "m.lua", red = scratch_ / "red", blue = scratch_ / "blue";
  ASSERT_EQ(run("run " + mission + " --out " + red).exit_code, 0);
  EXPECT_GT(share("red", 0), 0.05);
  EXPECT_EQ(share("red", 2), 0);
  EXPECT_EQ(run("verify " + red).exit_code, 0);

  // The pile was not made with this image: neither is it drawn with it.
  paint({20, 20, 220});
  const Outcome verify = run("verify " + red);
  EXPECT_NE(verify.exit_code, 0);
  EXPECT_NE(verify.err.find("block"), std::string::npos) << verify.err;
  ASSERT_EQ(run("run " + mission + " --out " + blue).exit_code, 0);
  EXPECT_GT(share("blue", 2), 0.05);
  EXPECT_EQ(share("blue", 0), 0);
}

TEST_F(PaintedPack, HasALookIfThePackSaysSo) {
  std::string text = read_file(scratch_ / "pack/pack.lua");
  text.insert(text.find(", material"), ", look = 'concrete_cast'");
  write_file(scratch_ / "pack/pack.lua", text);
  const std::string grey = scratch_ / "grey";
  ASSERT_EQ(run("run " + (scratch_ / "m.lua") + " --out " + grey).exit_code, 0);
  EXPECT_EQ(share("grey", 0), 0);
}

// A material that happens to be called as one of our looks: its image is meant, a plain colour is not.
TEST_F(PaintedPack, KeepsAnImageUnderTheNameOfALook) {
  std::string mesh = read_file(scratch_ / "pack/block.obj");
  mesh.replace(mesh.find("usemtl side"), 11, "usemtl glass");
  write_file(scratch_ / "pack/block.obj", mesh);
  write_file(scratch_ / "pack/block.mtl", "newmtl glass\nKd 1 1 1\nmap_Kd side.png\n");
  const std::string image = scratch_ / "image", plain = scratch_ / "plain";
  ASSERT_EQ(run("run " + (scratch_ / "m.lua") + " --out " + image).exit_code, 0);
  EXPECT_GT(share("image", 0), 0.05);
  write_file(scratch_ / "pack/block.mtl", "newmtl glass\nKd 1 0.05 0.05\n");
  ASSERT_EQ(run("run " + (scratch_ / "m.lua") + " --out " + plain).exit_code, 0);
  EXPECT_EQ(share("plain", 0), 0);
}

TEST_F(PaintedPack, GoesThroughCutsSheetsViewsAndExports) {
  const std::string out = scratch_ / "out", mission = scratch_ / "m.lua";
  ASSERT_EQ(run("settle " + mission + " --out " + out).exit_code, 0);
  const Outcome cut = run_rubble("cutaway " + out + " --y 0 --width 300 --out " + (scratch_ / "cut.png"));
  EXPECT_EQ(cut.exit_code, 0) << cut.err;
  const Outcome sheet = run_rubble("assets show " + (scratch_ / "pack") + " --out " + (scratch_ / "sheet.png"));
  EXPECT_EQ(sheet.exit_code, 0) << sheet.err;
  for (const std::string name : {"cut.png", "sheet.png"}) {
    const RgbImage image = read_rgb_png(scratch_ / name);
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
      count += image.rgb[i] > 2 * image.rgb[i + 1] && image.rgb[i] > 2 * image.rgb[i + 2];
    EXPECT_GT(double(count), 0.02 * double(image.rgb.size() / 3)) << name;
  }
  const Outcome exported = run_rubble("export " + out + " --format ply,obj,glb");
  EXPECT_EQ(exported.exit_code, 0) << exported.err;
  const std::string glb = read_file(out + "/export/pile.glb"), mtl = read_file(out + "/export/pile.mtl");
  EXPECT_NE(glb.find("image/png"), std::string::npos);
  EXPECT_NE(mtl.find("newmtl side_"), std::string::npos) << mtl;
  EXPECT_NE(mtl.find("Kd 0.57758"), std::string::npos) << mtl;  // (200 + 14.025) / 269.025 to the power of 2.4
}

// A scan as the ground: its colours are part of what a manifest names, though only its vertices have them.
TEST_F(PaintedPack, ATerrainOfOtherColoursIsAnother) {
  const auto write_scan = [&](const std::string& colour) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                       "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
                       "property list uchar int vertex_indices\nend_header\n";
    for (const char* place : {"-3 -3 0.1 ", "3 -3 0.1 ", "3 3 0.1 ", "-3 3 0.1 "}) text += place + colour + "\n";
    write_file(scratch_ / "scan.ply", text + "3 0 1 2\n3 0 2 3\n");
  };
  std::string mission = read_file(scratch_ / "m.lua");
  mission.replace(mission.find("layers = 0"), 10, "layers = 0, terrain = { file = 'scan.ply' }");
  write_file(scratch_ / "m.lua", mission);
  write_scan("20 200 30");
  const std::string out = scratch_ / "green";
  ASSERT_EQ(run("run " + (scratch_ / "m.lua") + " --out " + out).exit_code, 0);
  EXPECT_GT(share("green", 1), 0.2);
  const auto fly_again = [&] {
    return run("render " + out + " --mission " + (scratch_ / "m.lua") + " --force --out " + (scratch_ / "again"));
  };
  EXPECT_EQ(fly_again().exit_code, 0);
  write_scan("20 200 90");
  const Outcome other = fly_again();
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("the content"), std::string::npos) << other.err;
}

}  // namespace painted_pack_test
}  // namespace rubble::testing
