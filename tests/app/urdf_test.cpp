// Robots from URDF files: what is read, against closed forms, and files that are wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/geometry/shape.h"
#include "kernel/robot/parts.h"
#include "scripting/robots/robot_kind.h"
#include "tests/app/urdf_robots.h"

namespace rubble::testing {
namespace urdf_test {

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
  ASSERT_EQ(cart.model.frames.size(), 2U);
  EXPECT_EQ(cart.model.frames[1].name, "mast");
  EXPECT_NEAR(cart.model.frames[1].link_from_frame.translation.z, 0.25, 1e-12);
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
  ASSERT_EQ(cart.model.mimics.size(), 1U);
  const MimicJoint& mimic = cart.model.mimics[0];
  EXPECT_EQ(mimic.joint, 1);
  EXPECT_EQ(mimic.of, 0);
  EXPECT_EQ(mimic.multiplier, 0.5);
  EXPECT_EQ(mimic.offset, 0.01);
  EXPECT_EQ(cart.model.joints[1].start, 0.01) << "where the joint that it follows puts it";
}

// What the grammar refuses: tests/io/urdf_reader_test.cpp.
TEST(Urdf, MistakesAreNamedWithFileAndLine) {
  EXPECT_EQ(mistake_in(replaced(kCart, "type=\"prismatic\"><parent link=\"base_link\"/><child link=\"finger_b\"",
                                "type=\"floating\"><parent link=\"base_link\"/><child link=\"finger_b\""))
                .substr(0, 65),
            "a.urdf:26: slide_b: this type of joint is not supported here: exp");
  EXPECT_NE(mistake_in(replaced(kCart, "<inertia ixx=\"1e-4\" ixy=\"0\"", "<inertia ixx=\"-1e-4\" ixy=\"0\""))
                .find("a.urdf:18: finger_a: no body has these moments"), std::string::npos);
  EXPECT_NE(mistake_in(replaced(kCart, "<box size=\"0.4 0.3 0.1\"/>", "<mesh filename=\"package://x/gone.stl\"/>"))
                .find("a.urdf:7: base_link: its mesh is missing"), std::string::npos);
  EXPECT_NE(mistake_in(replaced(kCart, "<axis xyz=\"0 2 0\"/>", "<axis xyz=\"0 0 0\"/>"))
                .find("a.urdf:21: slide_a: its axis has no direction"), std::string::npos);
}

// Other programs do not look whether the joint is there: hands of public robots name one that is not.
TEST(Urdf, AJointThatMimicsNothingMovesByItself) {
  for (const char* of : {"nobody", "slide_b"}) {
    const MissionRobot made = read_robot(replaced(kCart, "mimic joint=\"slide_a\"", "mimic joint=\"" + std::string(of) + "\""));
    EXPECT_TRUE(made.model.mimics.empty()) << of;
    EXPECT_EQ(std::count_if(made.warnings.begin(), made.warnings.end(),
                            [&](const std::string& warning) {
                              return warning.find("a.urdf:26: the joint `slide_b` moves by itself: `" + std::string(of) + "`") != std::string::npos;
                            }), 1) << of;
  }
}

// All of its mass on a line: no moment about it but what rounding leaves.
TEST(Urdf, ALinkOnALineGetsASmallMoment) {
  const MissionRobot made = read_robot(replaced(
      kCart, "<inertia ixx=\"1e-4\" ixy=\"0\" ixz=\"0\" iyy=\"1e-4\" iyz=\"0\" izz=\"1e-4\"/>",
      "<inertia ixx=\"5.16880120038819E-09\" ixy=\"5.2958114515696E-10\" ixz=\"-1.89027241601897E-09\" "
      "iyy=\"5.53817365240935E-09\" iyz=\"1.34270833573428E-09\" izz=\"1.12172223189841E-09\"/>"));
  const auto finger = std::find_if(made.model.links.begin(), made.model.links.end(),
                                   [](const RobotLink& link) { return link.name == "finger_a"; });
  ASSERT_NE(finger, made.model.links.end());
  EXPECT_NEAR(finger->inertia.rows[0].x, 5.1688e-9, 1e-11);
  EXPECT_TRUE(std::any_of(made.warnings.begin(), made.warnings.end(), [](const std::string& warning) {
    return warning.find("no body has the moments of inertia of `finger_a`") != std::string::npos;
  }));
}

TEST(Urdf, JointsStartWithinRangesWithoutZeroAndWhereTheMissionPutsThem) {
  const std::string knee = arm("revolute", "<limit lower=\"-2.6\" upper=\"-0.8\" effort=\"20\" velocity=\"15\"/>", kArmMass);
  const MissionRobot made = read_robot(knee);
  EXPECT_EQ(made.model.joints[0].start, -0.8);
  const double at = state_after(made.model, 60).joints[0].position;
  EXPECT_LE(at, -0.8 + 0.01);
  EXPECT_GE(at, -2.6 - 0.01);
  RobotItem item;
  item.start = {{"j", -2}};
  EXPECT_EQ(read_robot(knee, item).model.joints[0].start, -2);
  item.start = {{"j", 0.5}};
  EXPECT_NE(mistake_in(knee, item).find("robots[1].start.j: outside of the joint's range: expected -2.6"), std::string::npos);
  item.start = {{"elbow", 0}};
  EXPECT_NE(mistake_in(knee, item).find("robots[1].start: the robot has no such joint that moves: expected one of j"), std::string::npos);
}

TEST(Urdf, BundledRobotsStartWhereTheMissionPutsThem) {
  MeshImporter importer;
  RobotItem item = make_robot_item("crawler");
  const std::string flipper = make_mission_robot(item, {}, "robots[1]", importer).model.joints.back().name;
  item.start = {{flipper, 0.4}};
  EXPECT_EQ(make_mission_robot(item, {}, "robots[1]", importer).model.joints.back().start, 0.4);
  item.model = make_robot_item("vine").model;
  EXPECT_THROW(make_mission_robot(item, {}, "robots[1]", importer), InputError);
}

TEST(Urdf, JointsWithoutAnEffortGetMotorsFromTheMission) {
  for (const char* limit : {"", "<limit effort=\"0\" velocity=\"0\"/>", "<limit/>"}) {
    const std::string text = arm("continuous", limit, kArmMass);
    const MissionRobot passive = read_robot(text);
    EXPECT_EQ(passive.model.joints[0].motor.effort, 0);
    EXPECT_TRUE(warns(passive, "a.urdf:4: joints without an effort in their <limit> have no motor: `j`")) << limit;
    RobotItem item;
    item.efforts = {{"j", 7}}, item.speeds = {{"j", 3}};
    const RobotMotor motor = read_robot(text, item).model.joints[0].motor;
    EXPECT_EQ(motor.effort, 7);
    EXPECT_EQ(motor.speed, 3);
    EXPECT_NEAR(motor.stiffness, 100, 1e-9);
    item.efforts = {{"k", 7}};
    EXPECT_NE(mistake_in(text, item).find("robots[1].efforts: the robot has no such joint that moves"), std::string::npos);
  }
}

// Twists need motors: of wheels without one, as TurtleBot3 and Husky have them.
TEST(Urdf, DrivenWheelsWithoutAnEffortCanSpinOnTheSpot) {
  std::string text = arm("continuous", "", kArmMass);
  text = replaced(text, "</robot>", "<link name=\"right\">" + std::string(kArmMass) + "</link><joint name=\"k\" type=\"continuous\">"
                  "<parent link=\"base_link\"/><child link=\"right\"/><origin xyz=\"0 -0.2 0\"/><axis xyz=\"0 1 0\"/></joint></robot>");
  RobotItem item;
  item.left_wheels = {"j"}, item.right_wheels = {"k"}, item.wheel_radius = 0.1;
  const MissionRobot made = read_robot(text, item);
  EXPECT_NEAR(made.model.joints[0].motor.effort, 6 * 9.81 * 0.1, 1e-9);
  EXPECT_TRUE(warns(made, "a.urdf:4: the wheel `j` has no effort in the file: its motor gets 5.89 N m"));
  item.efforts = {{"j", 2}, {"k", 2}};
  EXPECT_EQ(read_robot(text, item).model.joints[0].motor.effort, 2);
}

// Some public robots have them: Stretch, iCub, xArm 6, Mini Cheetah.
TEST(Urdf, MomentsThatNoBodyHasBecomeTheNearestPossible) {
  const auto inertia_of = [](const std::string& moments) {
    const MissionRobot made = read_robot(arm("continuous", "", "<inertial><mass value=\"0.5\"/><inertia " + moments + "/></inertial>"));
    EXPECT_TRUE(warns(made, "a.urdf:3: no body has the moments of inertia of `arm`")) << moments;
    return made.model.links[1].inertia;
  };
  // Second moments -0.5, 1.5 and 1.5 of 1e-4 become 0.0015, 1.5 and 1.5.
  const Mat3 plain = inertia_of("ixx=\"3e-4\" iyy=\"1e-4\" izz=\"1e-4\"");
  EXPECT_NEAR(plain.rows[0].x, 3e-4, 1e-12);
  EXPECT_NEAR(plain.rows[1].y, 1.5015e-4, 1e-12);
  EXPECT_NEAR(plain.rows[2].z, 1.5015e-4, 1e-12);
  // The same, turned by 45 degrees about Z.
  const Mat3 turned = inertia_of("ixx=\"2e-4\" ixy=\"1e-4\" iyy=\"2e-4\" izz=\"1e-4\"");
  EXPECT_NEAR(turned.rows[0].x, 2.25075e-4, 1e-12);
  EXPECT_NEAR(turned.rows[0].y, 0.74925e-4, 1e-12);
  EXPECT_NEAR(turned.rows[1].y, 2.25075e-4, 1e-12);
  EXPECT_NEAR(turned.rows[2].z, 1.5015e-4, 1e-12);
  EXPECT_EQ(turned.rows[0].y, turned.rows[1].x);
  // A rod without thickness.
  const Mat3 rod = inertia_of("ixx=\"0\" iyy=\"2e-4\" izz=\"2e-4\"");
  EXPECT_NEAR(rod.rows[0].x, 4e-7, 1e-12);
  EXPECT_NEAR(rod.rows[1].y, 2.002e-4, 1e-12);
  EXPECT_NE(mistake_in(arm("continuous", "", "<inertial><mass value=\"1\"/><inertia ixx=\"-1e-5\" iyy=\"2e-4\" izz=\"2e-4\"/></inertial>")),
            "none");
}

TEST(Urdf, LinksWithoutCollisionOrMassMoveAndTouchNothing) {
  const std::string limit = "<limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\"/>";
  const std::string visual = "<visual><geometry><box size=\"0.1 0.1 0.4\"/></geometry></visual>";
  const RobotState falling = state_after(read_robot(arm("revolute", limit, visual + kArmMass)).model, 60);
  EXPECT_NEAR(falling.links[1].world_from_link.translation.z, 3.3 - 0.5 * 9.81 * 0.0625, 0.02) << "it falls as one";
  const MissionRobot no_mass = read_robot(arm("revolute", limit, visual));
  EXPECT_NEAR(no_mass.model.links[1].mass, 4, 0.2) << "4 l of water";
  EXPECT_TRUE(warns(no_mass, "a.urdf:3: the link `arm` moves and has no mass: it gets 4"));
  const MissionRobot moments = read_robot(arm("revolute", limit, visual + "<inertial><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>"));
  EXPECT_NEAR(moments.model.links[1].mass, 4, 0.2);
  EXPECT_TRUE(warns(moments, "a.urdf:3: `arm` has moments of inertia without a mass"));
  const MissionRobot nothing = read_robot(arm("revolute", limit, ""));
  EXPECT_EQ(nothing.model.links[1].mass, 1e-3);
  EXPECT_TRUE(std::isfinite(state_after(nothing.model, 20).joints[0].position));
  const MissionRobot point = read_robot(arm("revolute", limit, visual + "<inertial><mass value=\"2\"/></inertial>"));
  EXPECT_EQ(point.model.links[1].mass, 2);
  EXPECT_NEAR(point.model.links[1].inertia.rows[2].z, 2 * 0.02 / 12, 1e-4) << "of the box";
  EXPECT_TRUE(warns(point, "has no moments of inertia"));
}

TEST(Urdf, ALinkCalledWorldFixesTheRobot) {
  const std::string limit = "<limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\"/>";
  const std::string free = arm("revolute", limit, kArmMass);
  const std::string text = replaced(free, "</robot>", "<link name=\"world\"/><joint name=\"fix\" type=\"fixed\"><parent link=\"world\"/>"
                                    "<child link=\"base_link\"/><origin xyz=\"0 0 0.5\"/></joint></robot>");
  const MissionRobot made = read_robot(text);
  EXPECT_EQ(made.model.links[0].name, "base_link") << "the frame `world` is the mission's";
  EXPECT_TRUE(made.model.fixed_base);
  EXPECT_NEAR(made.placed_from_base.translation.z, 0.5, 1e-12);
  const RobotState state = state_after(made.model, 60);
  EXPECT_EQ(state.links[0].world_from_link.translation.z, 3);
  EXPECT_LT(state_after(read_robot(free).model, 60).links[0].world_from_link.translation.z, 2.9) << "without it, it falls";
  // A cart on a rail that is the world itself.
  const MissionRobot cart = read_robot(replaced(arm("prismatic", limit, kArmMass, "world"), "<box size=\"0.4 0.2 0.1\"/>", "<box size=\"4 0.2 0.1\"/>"));
  EXPECT_EQ(cart.model.links[0].name, "r_base");
  EXPECT_TRUE(cart.model.fixed_base);
}

// A tetrahedron that is no mirror image of itself, scaled by -1.
TEST(Urdf, MirroredMeshesKeepTheirOutside) {
  const ScratchFolder folder;
  write_file(folder / "t.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  for (const char* scale : {"1 1 1", "1 -1 1", "-1 -1 -1", "-1 -1 1", "0.5 -2 1", "1 1 1 1"}) {
    const std::string mesh = std::string("<geometry><mesh filename=\"t.obj\" scale=\"") + scale + "\"/></geometry>";
    write_file(folder / "a.urdf", "<robot name=\"r\"><link name=\"a\"><visual>" + mesh + "</visual><collision>" + mesh +
                                      "</collision><inertial><mass value=\"1\"/></inertial></link></robot>");
    RobotItem robot;
    robot.urdf = "a.urdf";
    MeshImporter importer;
    const MissionRobot made = make_mission_robot(robot, {folder.path().string()}, "robots[1]", importer);
    EXPECT_NEAR(calc_volume_properties(make_link_mesh(made.model.links[0], "")).volume, 1, 1e-6) << scale;
    EXPECT_EQ(warns(made, "a.urdf:1: `scale` of <mesh> has four numbers"), scale == std::string("1 1 1 1"));
  }
}

TEST(Urdf, HostileFilesAreMistakes) {
  std::string deep = "<robot name=\"x\">";
  for (int i = 0; i < 3000; ++i) deep += "<link>";
  EXPECT_NE(mistake_in(deep), "none");
  EXPECT_NE(mistake_in("<robot name=\"x\"><link name=\"a\"/><link name=\"a\"/></robot>"), "none");
  EXPECT_NE(mistake_in(replaced(kCart, "0.4 0.3 0.1", "nan 0.3 0.1")), "none");
  EXPECT_NE(mistake_in(replaced(kCart, "0.4 0.3 0.1", "-1 0.3 0.1")), "none");
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

}  // namespace urdf_test
}  // namespace rubble::testing
