// Robots that were written as URDF, read again.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "app/robots/robot_files.h"
#include "io/robot/urdf_writer.h"
#include "kernel/robot/drive_commands.h"
#include "scripting/robots/rover.h"
#include "kernel/robot/odometry.h"
#include "kernel/world/world_robots.h"
#include "tests/app/urdf_robots.h"

namespace rubble::testing {
namespace urdf_test {

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
    const int robot = world.robots().add(*models[k], {{}, {0, 0, 0.001}});
    for (int i = 0; i < 480; ++i) {
      world.robots().set_command(robot, drive_sides(*models[k], 0.5, 0));
      world.step();
    }
    way[k] = world.robots().state(robot).links[0].world_from_link.translation.x;
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

}  // namespace urdf_test
}  // namespace rubble::testing
