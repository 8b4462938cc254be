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

// A frame on a link, such as a camera's: a link of a URDF file that is fixed to another.
using RobotFrame = UrdfFrame;

// A joint that a servo keeps at multiplier * q + offset of another.
struct MimicJoint {
  int joint = 0, of = 0;
  double multiplier = 1, offset = 0;
};

struct MissionRobot {
  RobotModel model;
  std::vector<RobotFrame> frames;
  std::vector<MimicJoint> mimics;
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

Pose calc_base_pose(const RobotItem& robot);
// Of the odometry of the mission's robot of that number, from 0.
OdometryNoise odometry_noise(const Scenario& scenario, std::size_t robot);

}  // namespace rubble
