// groundtruth.txt of the TUM RGB-D format: `stamp tx ty tz qx qy qz qw`, the pose of the colour
// camera's optical centre, in the optical frame (Z forward, X right, Y down), in the world.
#pragma once

#include <memory>
#include <string>

#include "io/recorder.h"

namespace rubble {

// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_tum_trajectory_recorder(const std::string& path);

}  // namespace rubble
