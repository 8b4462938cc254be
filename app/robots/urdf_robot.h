// From a URDF file to a robot that can be simulated.
//
// Links that are fixed to others become one body with them, and frames on it: base_footprint, mounts of
// sensors. Meshes are cut into convex parts, as those of assets. URDF knows no gains: a motor's position
// control reaches the joint's effort at an error of 0.07 rad (slider: 7 mm), its velocity control at a tenth of
// the joint's speed. Joints start at 0, or where their range is nearest to it.
#pragma once

#include "app/robots/mission_robot.h"
#include "io/robot/urdf_reader.h"

namespace rubble {

// key: of the robot, "robots[1]". Throws InputError: mistakes of the file have its name and line, those of the
// mission their key.
MissionRobot make_urdf_robot(const RobotItem& robot, const std::string& path, const std::string& key,
                             MeshImporter& importer);

}  // namespace rubble
