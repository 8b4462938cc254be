// A robot as URDF, for other programs: inertials, limits, and meshes that lie beside the file.
#pragma once

#include <string>
#include <vector>

#include "kernel/model/robot.h"

namespace rubble {

// Names of the meshes of a link, relative to the URDF file: its looks, and its convex part `part`.
std::string link_mesh_file(const std::string& folder, const std::string& link);
std::string part_mesh_file(const std::string& folder, const std::string& link, std::size_t part);

// A link without a body, fixed to another one.
struct UrdfFrame {
  std::string name;
  int link = 0;          // of the model
  Pose link_from_frame;  // unit: m
};

// folder: of the meshes, relative to the file. prefix: of the names of links, such as that of the robot's frames in
// /tf; the names of joints and files have none. Belts, friction and stiffness of motors have no place in URDF. Numbers
// read back to the same bits.
std::string robot_to_urdf(const RobotModel& model, const std::string& name, const std::string& folder,
                          const std::string& prefix = "", const std::vector<UrdfFrame>& frames = {});

}  // namespace rubble
