// From a URDF file to a robot that can be simulated.
//
// Links that are fixed to others become one body with them, and frames on it: base_footprint, mounts of
// sensors. Meshes are cut into convex parts, as those of assets. URDF knows no gains: a motor's position
// control reaches the joint's effort at an error of 0.07 rad (slider: 7 mm), its velocity control at a tenth of
// the joint's speed.
#pragma once

#include "app/robots/mission_robot.h"
#include "io/robot/urdf_reader.h"

namespace rubble {

MissionRobot make_urdf_robot(const RobotItem& robot, const std::string& path, const std::string& key,
                             MeshImporter& importer);

}  // namespace rubble
