// A robot as URDF, for other programs: inertials, limits, mimics, frames, and meshes that lie beside the file.
#pragma once

#include <string>
#include <vector>

#include "kernel/model/robot.h"

namespace rubble {

// Names of the meshes of a link, relative to the URDF file: its looks, and its convex part `part`.
std::string link_mesh_file(const std::string& folder, const std::string& link);
std::string part_mesh_file(const std::string& folder, const std::string& link, std::size_t part);

// The package that `robots/` of a run is (package.xml there): ROS finds meshes by it alone.
inline constexpr const char* kRobotsPackage = "rubble_robots";

// folder: of the meshes, relative to the file, or "package://..." prefix: of the names of links, such as that of the
// robot's frames in /tf; the names of joints and files have none. Belts, friction and stiffness of motors have no place
// in URDF. Numbers read back to the same bits. world_from_base: of a robot with a fixed base, which hangs on a link
// `world`.
std::string robot_to_urdf(const RobotModel& model, const std::string& name, const std::string& folder,
                          const std::string& prefix = "", const Pose& world_from_base = {});

}  // namespace rubble
