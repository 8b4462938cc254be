// Where the mesh files that a URDF file names lie on this machine.
#pragma once

#include <string>

namespace rubble {

// name: as the file has it: relative, absolute, "package://PACKAGE/PATH", "model://MODEL/PATH" or "file://PATH",
// with %20 and the like. Relative names and packages are looked for in the folder of the URDF file and in those
// that it lies in, whether or not PACKAGE is a folder there, then in $ROS_PACKAGE_PATH and $AMENT_PREFIX_PATH.
// Absolute paths are often those of another machine: their last folders are looked for as relative names are.
// Empty: there is no such file.
std::string find_urdf_mesh(const std::string& name, const std::string& urdf_path);

}  // namespace rubble
