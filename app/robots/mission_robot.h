// From a robot of a mission to its model: a bundled one, or one from a URDF file.
#pragma once

#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "io/robot/urdf_writer.h"
#include "kernel/model/robot.h"
#include "kernel/robot/odometry.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

struct MissionRobot {
  RobotModel model;
  Pose placed_from_base;  // of a URDF robot on a link `world`: from that link to its first body
  std::vector<std::string> warnings;  // of the file
};

// Where something is on a robot: on a link, or in a frame on one.
struct RiddenLink {
  std::size_t link = 0;
  Pose link_from_rider;  // unit: m
};
// The link or frame of that name; empty: the base. key: of what is on it. Throws InputError: the robot has none.
RiddenLink find_link(const MissionRobot& robot, const std::string& name, const std::string& key);

// folders: where a URDF file is looked for. key: of the robot, "robots[1]". Throws InputError: no such file,
// and what read_urdf and the making of the model find.
MissionRobot make_mission_robot(const RobotItem& robot, const std::vector<std::string>& folders,
                                const std::string& key, MeshImporter& importer);

// Of its first link, in the world.
Pose calc_base_pose(const RobotItem& robot, const MissionRobot& made);
// Of the odometry of the mission's robot of that number, from 0.
OdometryNoise odometry_noise(const Scenario& scenario, std::size_t robot);

}  // namespace rubble
