// What is allowed and hardly meant is said.
#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace rubble::testing {
namespace warnings_test {

constexpr char kCube[] =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl paint\n"
    "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n";

class Warnings : public ::testing::Test {
 protected:
  // What `check` prints for a pack of one asset with this mesh.
  std::string of_asset(const std::string& mesh, const std::string& more = "") {
    write_file(scratch_ / "a.obj", mesh);
    write_file(scratch_ / "pack.lua",
               "return pack { name = 'p', assets = { { name = 'a', mesh = 'a.obj', collision = "
               "'hull', material = 'brick'" +
                   more + " } } }\n");
    return of_mission("return rubble.mission { packs = { '.' }, pile = { mix = { { asset = 'a' } } } }");
  }
  std::string of_mission(const std::string& text) {
    write_file(scratch_ / "m.lua", text);
    const Outcome check = run_rubble("check " + (scratch_ / "m.lua"));
    EXPECT_EQ(check.exit_code, 0) << check.err;
    return check.err;
  }

  const ScratchFolder scratch_;
};

#define EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST_F(Warnings, OfASoundAssetThereAreNone) {
  EXPECT_EQ(of_asset(kCube), "");
  EXPECT_EQ(of_asset(kCube, ", looks = { paint = 'brick' }"), "");
}

TEST_F(Warnings, NameASurfaceThatTheMeshHasNot) {
  EXPECT_IN("`looks` of `a` names the surface `pain`, which the mesh does not have: did you mean `paint`?",
            of_asset(kCube, ", looks = { pain = 'brick' }"));
}

TEST_F(Warnings, NameAMeshThatIsFarTooSmallOrLarge) {
  EXPECT_IN("a.obj: the mesh is 1e-09 m large: are its `units` right?",
            of_asset("v 0 0 0\nv 1e-9 0 0\nv 0 1e-9 0\nv 0 0 1e-9\n"
                     "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"));
}

TEST_F(Warnings, NameAnEdgeOfAMeshThatIsNotClosed) {
  std::string open = kCube;
  open.erase(open.rfind("f 5 6 7 8"));
  const std::string said = of_asset(open);
  EXPECT_IN("a.obj: the mesh is not closed: 4 edges are not shared by two triangles", said);
  EXPECT_IN("the first, from (", said);
}

TEST_F(Warnings, NameAnImageOfAMeshThatCannotBeHad) {
  write_file(scratch_ / "a.mtl", "newmtl paint\nKd 0.8 0.1 0.1\nmap_Kd red.png\n");
  EXPECT_IN("a.obj: the image red.png lies neither beside the mesh nor in its folder textures",
            of_asset("mtllib a.mtl\n" + std::string(kCube)));
  EXPECT_EQ(of_asset("mtllib a.mtl\n" + std::string(kCube), ", look = 'brick'"), "") << "it is not asked for";
  write_file(scratch_ / "a.mtl", "newmtl paint\nKd 0.8 0.8 0.8\n");
  EXPECT_EQ(of_asset("mtllib a.mtl\n" + std::string(kCube)), "") << "grey is no colour";
}

TEST_F(Warnings, NameAnAngleThatLooksLikeRadians) {
  const std::string said = of_mission("return rubble.mission {\n  camera = { fov_deg = 1.57 } }");
  EXPECT_IN("m.lua:2: camera.fov_deg: 1.57 degrees is very narrow (is it in radians?)", said);
}

TEST_F(Warnings, NameARateThatStepsCannotKeep) {
  const auto said = [this](const std::string& hz) {
    return of_mission("return rubble.mission {\n  robots = { rubble.robot.crawler { position = { 0, 0, 0.1 } } },\n"
                      "  robot_run = { duration = 0.5, control_hz = " + hz + " } }");
  };
  EXPECT_IN("m.lua:3: robot_run.control_hz: commands and recordings have another rate", said("100"));
  EXPECT_IN("it is taken as 120 Hz", said("100"));
  for (const char* kept : {"120", "60", "30", "1", "240"}) EXPECT_EQ(said(kept).find("another rate"), std::string::npos) << kept;
}

TEST_F(Warnings, NameAFrameWhoseCameraIsBelowTheGround) {
  // A slope of 45 degrees from x = -1, z = 0 to x = 1, z = 2 in the second row of cases.
  const std::string slope = "terrain = { columns = 2, rows = 2, spacing = 2, heights = { 0, 2, 0, 2 } }";
  const struct {
    std::string terrain, z;
    bool below;
  } cases[] = {{"", "-0.1", true}, {"", "0.1", false}, {slope, "0.9", true}, {slope, "1.1", false}, {slope, "-0.1", true}};
  for (const auto& c : cases) {
    write_file(scratch_ / "m.lua",
               "return rubble.mission { pile = { layers = 0, " + c.terrain + " }, camera = { width = 32, height = 24 }, trajectory = {\n"
               "  rate_hz = 1, waypoints = { { t = 0, position = { 0, 0, 9 } }, { t = 1, position = { 0, 0, " + c.z + " } } } } }");
    const Outcome run = run_rubble("run " + (scratch_ / "m.lua") + " --quiet --force --out " + (scratch_ / "a"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string said = "the camera is below the ground at frame 1";
    EXPECT_EQ(run.err.find(said) != std::string::npos, c.below) << c.terrain << " " << c.z << "\n" << run.err;
  }
}

TEST_F(Warnings, NameASensorThatIsBelowTheGround) {
  write_file(scratch_ / "m.lua",
             "return rubble.mission { pile = { layers = 0 }, camera = { width = 32, height = 24 },\n"
             "  lidars = { low = { position = { 0, 0, -3 } }, high = { position = { 0, 0, 0.1 } } },\n"
             "  trajectory = { rate_hz = 1, waypoints = { { t = 0, position = { 0, 0, 5 } }, { t = 1, position = { 0, 0, 1 } } } } }");
  const Outcome run = run_rubble("run " + (scratch_ / "m.lua") + " --quiet --out " + (scratch_ / "a"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_IN("lidars.low is below the ground at frame 1, {0.00, 0.00, -2.00}", run.err);
  EXPECT_EQ(run.err.find("lidars.high"), std::string::npos) << run.err;
}

TEST_F(Warnings, NameASensorThatItsRobotCarriesBelowTheGround) {
  write_file(scratch_ / "m.lua",
             "return rubble.mission { pile = { layers = 0 }, camera = { width = 32, height = 24 },\n"
             "  robots = { rubble.robot.crawler { name = 'r', position = { 0, 0, 0.001 } } },\n"
             "  lidars = { low = { position = { 0.9, 0, -0.3 }, ride = { robot = 'r' } }, high = { position = { 0.9, 0, 0.3 }, ride = { robot = 'r' } } },\n"
             "  trajectory = { rate_hz = 5, ride = { robot = 'r', position = { 0.9, 0, 0.3 } } } }");
  const Outcome run = run_rubble("run " + (scratch_ / "m.lua") + " --quiet --out " + (scratch_ / "a"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_IN("lidars.low is below the ground at frame 0", run.err);
  EXPECT_IN("frames: move it on its robot, or the robot's way", run.err);
  EXPECT_EQ(run.err.find("lidars.high"), std::string::npos) << run.err;
}

TEST_F(Warnings, NameAPieceThatTheCameraIsInside) {
  std::string text = kTinyMission;
  text.replace(text.find("layers = 2"), 10,
               "placed = { { box = { 1, 4, 3 }, material = 'reinforced_concrete', position = { -1.5, "
               "0, 1.5 }, fixed = true } }, layers = 1");
  write_file(scratch_ / "m.lua", text);
  const Outcome run = run_rubble("run " + (scratch_ / "m.lua") + " --quiet --out " + (scratch_ / "a"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_IN("the camera is inside piece 0 (", run.err);
  EXPECT_IN("inside something or below the ground at 3 of 3 frames", run.err);
  EXPECT_IN("the camera is inside piece 0", read_file(scratch_ / "a/manifest.json"));
  write_file(scratch_ / "m.lua", kTinyMission);
  const Outcome outside =
      run_rubble("run " + (scratch_ / "m.lua") + " --quiet --out " + (scratch_ / "b"));
  EXPECT_EQ(outside.err.find("inside"), std::string::npos) << outside.err;
}

// What only the pile tells has its line as well.
TEST(BuildingErrors, HaveTheLinesOfTheirKeys) {
  const ScratchFolder scratch;
  const auto error_of = [&](const std::string& building) {
    write_file(scratch / "m.lua", "return rubble.mission {\n  packs = { 'residential' }, pile = { layers = 0, building = {\n" +
                                      building + " } } }");
    const Outcome run = run_rubble("settle " + (scratch / "m.lua") + " --quiet --out " + (scratch / "a"));
    EXPECT_EQ(run.exit_code, 1);
    return run.err;
  };
  EXPECT_IN("m.lua:4: pile.building.furniture[1].asset: does not fit into the building: expected lower than 1.69",
            error_of("storeys = 2, storey_height = 2.2,\nfurniture = { { asset = 'refrigerator' } }"));
  EXPECT_IN("m.lua:3: pile.building.infill_thickness: out of range",
            error_of("storeys = 2, column = 0.2, infill_thickness = 0.4"));
}

}  // namespace warnings_test
}  // namespace rubble::testing
