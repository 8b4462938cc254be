// Robots from URDF files: what is read, against closed forms and against the bundled robots written as URDF;
// and files that are wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/robots/mission_robot.h"
#include "app/robots/robot_files.h"
#include "app/robots/robot_log.h"
#include "io/robot/urdf_reader.h"
#include "io/robot/urdf_writer.h"
#include "kernel/base/error.h"
#include "kernel/robot/bundled.h"
#include "kernel/robot/gaits.h"
#include "kernel/robot/looks.h"
#include "kernel/robot/odometry.h"
#include "kernel/world/world.h"
#include "scripting/scenario/scenario.h"
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
    return at == std::string::npos || all.find("robots[1]") == 0 ? all : all.substr(at);
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
  EXPECT_NE(mistake_in(replaced(kCart, "mimic joint=\"slide_a\"", "mimic joint=\"nobody\""))
                .find("a.urdf:26: slide_b: mimics a joint that does not move"), std::string::npos);
  EXPECT_NE(mistake_in(replaced(kCart, "mimic joint=\"slide_a\"", "mimic joint=\"slide_b\""))
                .find("slide_b: mimics a joint that does not move"), std::string::npos);
}

// A base of 5 kg, and an arm on a joint: attributes of the joint, and what is within joint and arm.
std::string arm(const std::string& type, const std::string& joint, const std::string& link, const std::string& base = "base_link") {
  return "<robot name=\"r\">\n<link name=\"" + base + "\"><collision><geometry><box size=\"0.4 0.2 0.1\"/></geometry></collision>"
         "<inertial><mass value=\"5\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\"/></inertial></link>\n"
         "<link name=\"arm\">" + link + "</link>\n<joint name=\"j\" type=\"" + type + "\"><parent link=\"" + base +
         "\"/><child link=\"arm\"/><origin xyz=\"0.2 0 0.3\"/><axis xyz=\"0 1 0\"/>" + joint + "</joint>\n</robot>\n";
}
const char* const kArmMass = "<inertial><mass value=\"0.5\"/><inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\"/></inertial>";

bool warns(const MissionRobot& robot, const std::string& part) {
  return std::any_of(robot.warnings.begin(), robot.warnings.end(),
                     [&](const std::string& warning) { return warning.find(part) != std::string::npos; });
}

// The robot in a world without ground for some steps.
RobotState state_after(const RobotModel& model, int steps) {
  WorldOptions options;
  options.threads = 1;
  World world({}, options);
  world.set_step(1.0 / 240, 4);
  const int robot = world.add_robot(model, {{}, {0, 0, 3}});
  for (int i = 0; i < steps; ++i) world.step();
  return world.robot_state(robot);
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
  RobotItem item;
  item.model = RobotKind::crawler;
  const std::string flipper = make_mission_robot(item, {}, "robots[1]", importer).model.joints.back().name;
  item.start = {{flipper, 0.4}};
  EXPECT_EQ(make_mission_robot(item, {}, "robots[1]", importer).model.joints.back().start, 0.4);
  item.model = RobotKind::vine;
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
  for (const char* scale : {"1 1 1", "1 -1 1", "-1 -1 -1", "-1 -1 1", "0.5 -2 1"}) {
    const std::string mesh = std::string("<geometry><mesh filename=\"t.obj\" scale=\"") + scale + "\"/></geometry>";
    write_file(folder / "a.urdf", "<robot name=\"r\"><link name=\"a\"><visual>" + mesh + "</visual><collision>" + mesh +
                                      "</collision><inertial><mass value=\"1\"/></inertial></link></robot>");
    RobotItem robot;
    robot.urdf = "a.urdf";
    MeshImporter importer;
    const MissionRobot made = make_mission_robot(robot, {folder.path().string()}, "robots[1]", importer);
    EXPECT_NEAR(calc_volume_properties(make_link_mesh(made.model.links[0], "")).volume, 1, 1e-6) << scale;
  }
}

TEST(Urdf, WrittenRobotsKeepMimicsFramesAndMotors) {
  const ScratchFolder folder;
  const MissionRobot cart = read_robot(kCart);
  write_robot_description(folder.path().string(), "cart", cart.model);
  RobotItem item;
  item.urdf = "cart.urdf";
  MeshImporter importer;
  const MissionRobot again = make_mission_robot(item, {folder.path().string()}, "robots[1]", importer);
  ASSERT_EQ(again.model.mimics.size(), 1U);
  EXPECT_EQ(again.model.mimics[0].multiplier, 0.5);
  EXPECT_EQ(again.model.mimics[0].offset, 0.01);
  ASSERT_EQ(again.model.frames.size(), cart.model.frames.size());
  EXPECT_EQ(again.model.joints[0].motor.effort, 20);
  // Meshes as ROS looks for them; efforts of endless joints; names beyond ASCII.
  RobotModel model = make_rover();
  model.links[0].name = "L\xc3\xb6we";
  model.joints[0].motor = {};
  const std::string text = robot_to_urdf(model, "rover", "package://rubble_robots/rover_meshes");
  EXPECT_NE(text.find("<link name=\"L\xc3\xb6we\">"), std::string::npos);
  EXPECT_NE(text.find("filename=\"package://rubble_robots/rover_meshes/"), std::string::npos);
  const std::string wheel = text.substr(text.find("<joint name=\"" + model.joints[0].name));
  EXPECT_EQ(wheel.substr(0, wheel.find("</joint>")).find("effort"), std::string::npos) << "no motor, no limit";
  const std::string driven = text.substr(text.find("<joint name=\"" + model.joints[1].name));
  EXPECT_NE(driven.substr(0, driven.find("</joint>")).find("<limit effort=\"6\""), std::string::npos);
  model.fixed_base = true;
  EXPECT_NE(robot_to_urdf(model, "rover", "m").find("<parent link=\"world\"/><child link=\"L\xc3\xb6we\"/>"), std::string::npos);
}

// A camera's link of the robot beside the frame of the mission's camera.
TEST(Urdf, FramesOfRobotsDoNotClashWithThoseOfSensors) {
  Scenario scenario;
  scenario.robots.resize(1);
  scenario.robots[0].name = "bot";
  const auto with = [](std::string text, const std::string& name) {
    for (std::size_t at = 0; (at = text.find("\"mast\"", at)) != std::string::npos; ++at) text.replace(at, 6, "\"" + name + "\"");
    return text;
  };
  const auto record_of = [&](const std::string& name) {
    return describe_robots(scenario, {read_robot(with(kCart, name))}).front();
  };
  EXPECT_EQ(record_of("mast").frame, "");
  EXPECT_EQ(record_of("base_mast").frame_of(0), "base_footprint");
  for (const char* taken : {"camera_link", "camera_optical_frame", "odom", "world"}) {
    const RobotRecord record = record_of(taken);
    EXPECT_EQ(record.frame, "bot/") << taken;
    EXPECT_EQ(record.topic, "") << "topics are not frames";
  }
  EXPECT_EQ(record_of("/X1/mast").frame_named("/X1/mast"), "X1/mast") << "tf2 refuses slashes in front";
  EXPECT_EQ(record_of("L\xc3\xb6we").frame_named("L\xc3\xb6we"), "L\xc3\xb6we");
  scenario.imu.frame_id = "bot/mast";
  EXPECT_EQ(record_of("mast").frame, "") << "bot/mast is another frame than mast";
  scenario.imu.frame_id = "bot/camera_link";
  EXPECT_THROW(record_of("camera_link"), InputError);
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

// One run with much of what files of the field have: Latin-1, a transmission, a mast without collision, a knee whose range
// has no 0, a link with the name of the camera's frame.
TEST(Urdf, AMissionDrivesARobotOfTheField) {
  const ScratchFolder scratch;
  const std::string moves = "<limit lower=\"-2.6\" upper=\"-0.8\" effort=\"20\" velocity=\"15\"/>";
  std::string text = arm("revolute", moves, "<visual><geometry><box size=\"0.1 0.1 0.4\"/></geometry></visual>" + std::string(kArmMass));
  text = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>" + replaced(text, "robot name=\"r\"", "robot name=\"R\xe4upe\"");
  text = replaced(text, "</robot>", "<link name=\"camera_link\"/><joint name=\"c\" type=\"fixed\"><parent link=\"base_link\"/>"
                  "<child link=\"camera_link\"/></joint><transmission name=\"t\"><joint name=\"j\"/></transmission></robot>");
  write_file(scratch / "r.urdf", text);
  write_file(scratch / "m.lua", R"(return rubble.mission { pile = { layers = 0 },
    robots = { { urdf = "r.urdf", name = "bot", position = { 0, 0, 0.4 }, start = { j = -1 } } },
    robot_run = { duration = 0.1 }, camera = { width = 16, height = 16 },
    trajectory = { rate_hz = 0.1, ride = { robot = "bot", link = "camera_link" } },
    outputs = { rawlog = false, simplemap = false } })");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --out " + (scratch / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(text.find("<transmission")), '\n');
  EXPECT_NE(run.err.find("r.urdf:" + std::to_string(line) + ": <transmission> is left out"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("its link `camera_link` has the name of another frame of the mission"), std::string::npos) << run.err;
  EXPECT_NE(read_file(scratch / "out/robots/robots.json").find("\"model\": \"R\xc3\xa4upe\""), std::string::npos);
  EXPECT_NE(read_file(scratch / "out/robots/package.xml").find("<name>rubble_robots</name>"), std::string::npos);
  const std::string joints = read_file(scratch / "out/robots/bot_joints.csv");
  EXPECT_NE(joints.find("j_position"), std::string::npos);
  EXPECT_NE(joints.find(",-1,"), std::string::npos) << "the start: " << joints;
  // More values than motors.
  write_file(scratch / "n.lua", replaced(read_file(scratch / "m.lua"), "start = { j = -1 }", "drive = { { t = 0, joints = { -1, 2 } } }"));
  const Outcome more = run_rubble("run " + (scratch / "n.lua") + " --out " + (scratch / "more"));
  EXPECT_EQ(more.exit_code, 1);
  EXPECT_NE(more.err.find("n.lua:2: robots[1].drive[1].joints: more values than the robot has motors at joints: expected 1 at most: j, "
                          "found 2"), std::string::npos) << more.err;
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
