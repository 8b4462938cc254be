// URDF texts of small robots, and what becomes of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "app/robots/mission_robot.h"
#include "kernel/base/error.h"
#include "kernel/world/world.h"
#include "kernel/world/world_robots.h"
#include "scripting/scenario/scenario.h"
#include "tests/app/program.h"

namespace rubble::testing::urdf_test {

// A cart: a footprint without mass, a body with a mast fixed to it, a gripper whose fingers mimic each other.
inline constexpr const char* kCart = R"(<?xml version="1.0"?>
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

inline MissionRobot read_robot(const std::string& text, const RobotItem& item = {}) {
  const ScratchFolder folder;
  write_file(folder / "a.urdf", text);
  RobotItem robot = item;
  robot.urdf = "a.urdf";
  MeshImporter importer;
  return make_mission_robot(robot, {folder.path().string()}, "robots[1]", importer);
}

// The first mistake in it, from "a.urdf" on.
inline std::string mistake_in(const std::string& text, const RobotItem& item = {}) {
  try {
    read_robot(text, item);
  } catch (const InputError& error) {
    const std::string all = error.what();
    const std::size_t at = all.find("a.urdf");
    return at == std::string::npos || all.find("robots[1]") == 0 ? all : all.substr(at);
  }
  return "none";
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

// A base of 5 kg, and an arm on a joint: attributes of the joint, and what is within joint and arm.
inline std::string arm(const std::string& type, const std::string& joint, const std::string& link, const std::string& base = "base_link") {
  return "<robot name=\"r\">\n<link name=\"" + base + "\"><collision><geometry><box size=\"0.4 0.2 0.1\"/></geometry></collision>"
         "<inertial><mass value=\"5\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\"/></inertial></link>\n"
         "<link name=\"arm\">" + link + "</link>\n<joint name=\"j\" type=\"" + type + "\"><parent link=\"" + base +
         "\"/><child link=\"arm\"/><origin xyz=\"0.2 0 0.3\"/><axis xyz=\"0 1 0\"/>" + joint + "</joint>\n</robot>\n";
}
inline constexpr const char* kArmMass = "<inertial><mass value=\"0.5\"/><inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\"/></inertial>";

inline bool warns(const MissionRobot& robot, const std::string& part) {
  return std::any_of(robot.warnings.begin(), robot.warnings.end(),
                     [&](const std::string& warning) { return warning.find(part) != std::string::npos; });
}

// The robot in a world without ground for some steps.
inline RobotState state_after(const RobotModel& model, int steps) {
  WorldOptions options;
  options.threads = 1;
  World world({}, options);
  world.set_step(1.0 / 240, 4);
  const int robot = world.robots().add(model, {{}, {0, 0, 3}});
  for (int i = 0; i < steps; ++i) world.step();
  return world.robots().state(robot);
}

}  // namespace rubble::testing::urdf_test
