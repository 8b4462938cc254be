// Robots from URDF files: what is read, against closed forms and against the bundled robots written as URDF;
// and files that are wrong.
#include <gtest/gtest.h>

#include <cmath>

#include "app/robots/mission_robot.h"
#include "app/robots/robot_files.h"
#include "io/robot/urdf_reader.h"
#include "io/robot/urdf_writer.h"
#include "kernel/base/error.h"
#include "kernel/robot/bundled.h"
#include "kernel/robot/gaits.h"
#include "kernel/robot/looks.h"
#include "kernel/robot/odometry.h"
#include "kernel/world/world.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace urdf_test {

// A cart: a footprint without mass, a body with a mast fixed to it, a gripper whose fingers mimic each other.
const char* const kCart = R"(<?xml version="1.0"?>
<robot name="cart">
  <link name="base_footprint"/>
  <link name="base_link">
    <inertial><origin xyz="0 0 0.1"/><mass value="8"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.4 0.3 0.1"/></geometry></collision>
  </link>
  <joint name="footprint" type="fixed"><parent link="base_footprint"/><child link="base_link"/>
    <origin xyz="0 0 0.05"/></joint>
  <link name="mast">
    <inertial><origin xyz="0 0 0.5"/><mass value="2"/>
      <inertia ixx="0.04" ixy="0" ixz="0" iyy="0.04" iyz="0" izz="0.001"/></inertial>
    <visual><geometry><cylinder radius="0.02" length="1"/></geometry></visual>
  </link>
  <joint name="mast_joint" type="fixed"><parent link="base_link"/><child link="mast"/>
    <origin xyz="0.1 0 0.2" rpy="0 0 1.5707963267948966"/></joint>
  <link name="finger_a"><inertial><mass value="0.1"/>
    <inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
  <joint name="slide_a" type="prismatic"><parent link="base_link"/><child link="finger_a"/>
    <origin xyz="0.3 0.05 0.2"/><axis xyz="0 2 0"/>
    <limit lower="-0.01" upper="0.04" effort="20" velocity="0.2"/>
    <dynamics damping="3" friction="0.5"/></joint>
  <link name="finger_b"><inertial><mass value="0.1"/>
    <inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
  <joint name="slide_b" type="prismatic"><parent link="base_link"/><child link="finger_b"/>
    <origin xyz="0.3 -0.05 0.2"/><axis xyz="0 -1 0"/>
    <limit lower="-0.01" upper="0.04" effort="20" velocity="0.2"/>
    <mimic joint="slide_a" multiplier="0.5" offset="0.01"/></joint>
  <transmission name="t"/>
</robot>
)";

MissionRobot read_robot(const std::string& text, const RobotItem& item = {}) {
  const ScratchFolder folder;
  write_file(folder / "a.urdf", text);
  RobotItem robot = item;
  robot.urdf = "a.urdf";
  MeshImporter importer;
  return make_mission_robot(robot, {folder.path().string()}, "robots[1]", importer);
}

// The first mistake in it, from "a.urdf" on.
std::string mistake_in(const std::string& text, const RobotItem& item = {}) {
  try {
    read_robot(text, item);
  } catch (const InputError& error) {
    const std::string all = error.what();
    const std::size_t at = all.find("a.urdf");
    return at == std::string::npos ? all : all.substr(at);
  }
  return "none";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(Urdf, FixedLinksAreOneBodyWithTheirCommonMassAndInertia) {
  const MissionRobot cart = read_robot(kCart);
  ASSERT_EQ(cart.model.links.size(), 3U);
  const RobotLink& body = cart.model.links[0];
  EXPECT_EQ(body.name, "base_footprint");
  EXPECT_DOUBLE_EQ(body.mass, 10);
  // Centres: 8 kg at z = 0.15, 2 kg at (0.1, 0, 0.75).
  EXPECT_NEAR(body.centre_of_mass.x, 0.02, 1e-12);
  EXPECT_NEAR(body.centre_of_mass.z, 0.27, 1e-12);
  // Steiner: ixx = 0.1 + 8 0.12^2 + 0.04 + 2 0.48^2; the mast is turned about z, where it is round.
  EXPECT_NEAR(body.inertia.rows[0].x, 0.1 + 8 * 0.0144 + 0.04 + 2 * 0.2304, 1e-12);
  EXPECT_NEAR(body.inertia.rows[2].z, 0.25 + 8 * 0.0004 + 0.001 + 2 * 0.0064, 1e-12);
  EXPECT_NEAR(body.inertia.rows[0].z, -(8 * 0.02 * 0.12 + 2 * 0.08 * 0.48), 1e-12);
  ASSERT_EQ(cart.frames.size(), 2U);
  EXPECT_EQ(cart.frames[1].name, "mast");
  EXPECT_NEAR(cart.frames[1].link_from_frame.translation.z, 0.25, 1e-12);
  ASSERT_EQ(cart.warnings.size(), 1U);
  EXPECT_NE(cart.warnings[0].find("a.urdf:30: <transmission> is left out"), std::string::npos) << cart.warnings[0];
}

TEST(Urdf, JointsHaveTheirLimitsEffortsAndDampingAndMimicEachOther) {
  const MissionRobot cart = read_robot(kCart);
  ASSERT_EQ(cart.model.joints.size(), 2U);
  const RobotJoint& slide = cart.model.joints[0];
  EXPECT_EQ(slide.name, "slide_a");
  EXPECT_EQ(slide.kind, JointKind::slider);
  EXPECT_DOUBLE_EQ(slide.axis.y, 1) << "made a unit vector";
  EXPECT_EQ(slide.lower, -0.01);
  EXPECT_EQ(slide.upper, 0.04);
  EXPECT_EQ(slide.motor.effort, 20);
  EXPECT_EQ(slide.motor.speed, 0.2);
  EXPECT_EQ(slide.damping, 3);
  EXPECT_EQ(slide.friction, 0.5);
  EXPECT_NEAR(slide.parent_from_child.translation.z, 0.25, 1e-12) << "from the footprint";
  ASSERT_EQ(cart.mimics.size(), 1U);
  EXPECT_EQ(cart.mimics[0].joint, 1);
  EXPECT_EQ(cart.mimics[0].of, 0);
  EXPECT_EQ(cart.mimics[0].multiplier, 0.5);
  EXPECT_EQ(cart.mimics[0].offset, 0.01);
}

TEST(Urdf, MistakesAreNamedWithFileAndLine) {
  EXPECT_EQ(mistake_in(replaced(kCart, "type=\"prismatic\"><parent link=\"base_link\"/><child link=\"finger_b\"",
                                "type=\"floating\"><parent link=\"base_link\"/><child link=\"finger_b\""))
                .substr(0, 60),
            "a.urdf:26: slide_b: this type of joint is not supported: exp");
  EXPECT_NE(mistake_in(replaced(kCart, "<mass value=\"8\"/>", "<mass value=\"0\"/>"))
                .find("a.urdf:2"), 0U) << "the mast still has a mass";
  EXPECT_NE(mistake_in(replaced(kCart, "<link name=\"finger_b\"><inertial><mass value=\"0.1\"/>",
                                "<link name=\"finger_b\"><inertial><mass value=\"0\"/>"))
                .find("a.urdf:24: finger_b: has no mass, and is a body of its own"), std::string::npos);
  EXPECT_NE(mistake_in(replaced(kCart, "<inertia ixx=\"1e-4\" ixy=\"0\" ixz=\"0\" iyy=\"1e-4\" iyz=\"0\" izz=\"1e-4\"/>",
                                "<inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\"/>"))
                .find("a.urdf:18: finger_a: no body has these moments"), std::string::npos);
  const auto closed_by = [](const std::string& parent, const std::string& child) {
    return replaced(kCart, "</robot>", "<joint name=\"z\" type=\"fixed\"><parent link=\"" + parent +
                                           "\"/><child link=\"" + child + "\"/></joint></robot>");
  };
  EXPECT_NE(mistake_in(closed_by("mast", "finger_a"))
                .find("closes a loop: link `finger_a` hangs on another joint already"), std::string::npos);
  EXPECT_NE(mistake_in(closed_by("mast", "base_footprint")).find("cannot be read as URDF"), std::string::npos);
  EXPECT_NE(mistake_in(replaced(kCart, "<box size=\"0.4 0.3 0.1\"/>", "<mesh filename=\"package://x/gone.stl\"/>"))
                .find("a.urdf:4: base_link: its mesh is missing"), std::string::npos);
  EXPECT_NE(mistake_in(replaced(kCart, "lower=\"-0.01\"", "lower=\"0.02\""))
                .find("a.urdf:20: slide_a: its zero lies outside of its limits"), std::string::npos);
  EXPECT_NE(mistake_in(replaced(kCart, "<axis xyz=\"0 2 0\"/>", "<axis xyz=\"0 0 0\"/>"))
                .find("slide_a: its axis has no direction"), std::string::npos);
  EXPECT_NE(mistake_in(replaced(kCart, "mimic joint=\"slide_a\"", "mimic joint=\"nobody\""))
                .find("slide_b: mimics a joint that does not move"), std::string::npos);
  EXPECT_NE(mistake_in("<robot name=\"x\"><link").find("cannot be read as URDF"), std::string::npos);
  EXPECT_NE(mistake_in("").find("cannot be read as URDF"), std::string::npos);
}

TEST(Urdf, HostileFilesAreMistakes) {
  std::string deep = "<robot name=\"x\">";
  for (int i = 0; i < 3000; ++i) deep += "<link>";
  EXPECT_NE(mistake_in(deep), "none");
  EXPECT_NE(mistake_in("<robot name=\"x\"><link name=\"a\"/><link name=\"a\"/></robot>"), "none");
  EXPECT_NE(mistake_in(replaced(kCart, "0.4 0.3 0.1", "nan 0.3 0.1")), "none");
  EXPECT_NE(mistake_in(replaced(kCart, "0.4 0.3 0.1", "-1 0.3 0.1")), "none");
}

RobotItem rover_item() {
  RobotItem item;
  item.left_wheels = {"front_left_wheel_joint", "rear_left_wheel_joint"};
  item.right_wheels = {"front_right_wheel_joint", "rear_right_wheel_joint"};
  item.wheel_radius = kRoverWheelRadius;
  item.friction = 0.8;
  return item;
}

// The bundled rover as the URDF that a run writes, read again.
MissionRobot rover_from_file(const std::string& folder, const RobotItem& like) {
  const RobotModel model = make_rover();
  write_robot_description(folder, "rover", model);
  RobotItem item = like;
  item.urdf = "rover.urdf";
  MeshImporter importer;
  return make_mission_robot(item, {folder}, "robots[1]", importer);
}

TEST(Urdf, ARobotThatWasWrittenIsReadAsItWas) {
  const ScratchFolder folder;
  const RobotModel model = make_rover();
  const MissionRobot read = rover_from_file(folder.path().string(), rover_item());
  ASSERT_EQ(read.model.links.size(), model.links.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto at = std::find_if(read.model.links.begin(), read.model.links.end(),
                                 [&](const RobotLink& link) { return link.name == model.links[i].name; });
    ASSERT_NE(at, read.model.links.end());
    EXPECT_NEAR(at->mass, model.links[i].mass, 1e-12);
    EXPECT_LT(distance(at->centre_of_mass, model.links[i].centre_of_mass), 1e-12);
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(distance(at->inertia.rows[k], model.links[i].inertia.rows[k]), 1e-9);
    EXPECT_EQ(at->parts.size(), model.links[i].parts.size());
  }
  EXPECT_NEAR(read.model.sides.distance, kRoverTrackDistance, 1e-9);
}

// Materials of the file, colours of meshes, and neither; each link has one mesh of them.
TEST(Urdf, VisualsKeepTheColoursOfTheirFiles) {
  const ScratchFolder folder;
  write_file(folder / "mast.mtl", "newmtl red\nKd 0.9 0.1 0\nnewmtl blue\nKd 0 0.1 0.9\n");
  write_file(folder / "mast.obj", "mtllib mast.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 3 2\nf 1 2 4\n"
                                  "usemtl blue\nf 2 3 4\nf 1 4 3\n");
  const auto looks_with = [&](const std::string& visuals) {
    write_file(folder / "a.urdf", replaced(kCart, "<visual><geometry><cylinder radius=\"0.02\" length=\"1\"/></geometry></visual>", visuals));
    RobotItem robot;
    robot.urdf = "a.urdf";
    MeshImporter importer;
    const MissionRobot made = make_mission_robot(robot, {folder.path().string()}, "robots[1]", importer);
    return make_link_mesh(made.model.links[0], "");
  };
  const std::string mesh = "<geometry><mesh filename=\"mast.obj\"/></geometry>", box = "<geometry><box size=\"1 1 1\"/></geometry>";
  const TriangleMesh plain = looks_with("<visual>" + box + "</visual>");
  EXPECT_TRUE(plain.paints.empty());
  const TriangleMesh both = looks_with("<visual>" + box + "</visual><visual>" + mesh + "</visual>");
  ASSERT_EQ(both.surface_names.size(), 3u) << "what has no colours, red, blue";
  EXPECT_EQ(both.paint_of(0), nullptr);
  EXPECT_FLOAT_EQ(both.paint_of(1)->colour.x, 0.9f);
  EXPECT_FLOAT_EQ(both.paint_of(2)->colour.z, 0.9f);
  EXPECT_EQ(both.paint_corners.size(), both.triangles.size());
  EXPECT_EQ(std::count(both.surfaces.begin(), both.surfaces.end(), 2), 2);
  const std::string green = "<material name=\"g\"><color rgba=\"0 0.5 0 1\"/></material>";
  const TriangleMesh over = looks_with("<visual>" + mesh + green + "</visual>");
  ASSERT_EQ(over.surface_names.size(), 2u);
  EXPECT_EQ(std::count(over.surfaces.begin(), over.surfaces.end(), 1), 4) << "a material of the file is over all of a mesh";
  EXPECT_NEAR(double(over.paint_of(1)->colour.y), 0.2140, 1e-3) << "it is sRGB";
}

// And drives as far.
TEST(Urdf, ARoverFromAFileDrivesAsTheBundledOne) {
  const ScratchFolder folder;
  const MissionRobot read = rover_from_file(folder.path().string(), rover_item());
  const RobotModel bundled = make_rover();
  double way[2] = {0, 0};
  const RobotModel* models[2] = {&bundled, &read.model};
  for (int k = 0; k < 2; ++k) {
    WorldOptions options;
    options.threads = 1;
    World world({}, options);
    world.set_step(1.0 / 240, 4);
    const int robot = world.add_robot(*models[k], {{}, {0, 0, 0.001}});
    for (int i = 0; i < 480; ++i) {
      world.set_command(robot, drive_wheels(*models[k], {0.5, 0}));
      world.step();
    }
    way[k] = world.robot_state(robot).links[0].world_from_link.translation.x;
  }
  EXPECT_GT(way[0], 0.9);
  EXPECT_NEAR(way[1], way[0], 0.02) << "gains are softer: it gathers speed later";
}

TEST(Urdf, WheelsThatAreNoneAreMistakesOfTheMission) {
  const ScratchFolder folder;
  RobotItem item = rover_item();
  item.left_wheels[0] = "fifth_wheel";
  try {
    rover_from_file(folder.path().string(), item);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].key, "robots[1].left_wheels");
    EXPECT_EQ(error.diagnostics()[0].found, "\"fifth_wheel\"");
  }
  item = rover_item();
  std::swap(item.left_wheels, item.right_wheels);
  EXPECT_THROW(rover_from_file(folder.path().string(), item), InputError);
}

// Through the program: a mission with a file beside it, verified from its manifest.
TEST(Urdf, AMissionDrivesARobotFromAFile) {
  const ScratchFolder scratch;
  write_robot_description(scratch.path().string(), "rover", make_rover());
  write_file(scratch / "m.lua", R"(return rubble.mission { pile = { layers = 0 },
    robots = { { urdf = "rover.urdf", name = "buggy", position = { 0, 0, 0.001 }, friction = 0.8,
      left_wheels = { "front_left_wheel_joint", "rear_left_wheel_joint" },
      right_wheels = { "front_right_wheel_joint", "rear_right_wheel_joint" }, wheel_radius = 0.098,
      drive = { { t = 0, linear = 0.5 } } } },
    robot_run = { duration = 2 }, camera = { width = 32, height = 32 },
    trajectory = { rate_hz = 2, ride = { robot = "buggy", position = { 0.3, 0, 0.3 } } },
    outputs = { bag = false, rawlog = false, simplemap = false } })");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --out " + (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(read_file(scratch / "out/robots/buggy_odometry.csv").find("slip_left"), std::string::npos);
  const Outcome verified = run_rubble("verify " + (scratch / "out"));
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

// Where a user stands most often: files that the mission names have no folder in their path then.
TEST(Urdf, AMissionIsRunFromItsOwnFolder) {
  const ScratchFolder scratch;
  write_robot_description(scratch.path().string(), "rover", make_rover());
  write_file(scratch / "hill.obj", "v -4 -4 0.1\nv 4 -4 0.1\nv 4 4 0.1\nv -4 4 0.1\nv 0 0 0.4\n"
                                   "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  write_file(scratch / "m.lua", R"(return rubble.mission {
  pile = { layers = 1, pieces_per_layer = 3, terrain = { file = "hill.obj" } },
  robots = { { urdf = "rover.urdf", name = "rover", position = { 0, -3, 1 } } }, robot_run = { duration = 0.1 },
  camera = { width = 32, height = 24 },
  trajectory = { waypoints = { { position = { -6, 0, 3 }, look_at = { 0, 0, 0 } } } },
})");
  const std::string command = "cd '" + scratch.path().string() + "' && '" RUBBLE_PROGRAM "' run m.lua --quiet --out out 2>err";
  const int status = std::system(command.c_str());
  EXPECT_EQ(status, 0) << read_file(scratch / "err");
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/manifest.json"));
}

}  // namespace urdf_test
}  // namespace rubble::testing
