// Trajectories in files: what SLAM programs write and what ours writes as ground truth.
#pragma once

#include <string>
#include <vector>

#include "scripting/trajectory/trajectory_text.h"

namespace rubble {

// parse_trajectory() of a file. Throws InputError with file and line.
RecordedTrajectory load_recorded_trajectory(const std::string& path, const std::string& columns = "");

// Its poses alone.
std::vector<StampedPose> load_trajectory(const std::string& path);

}  // namespace rubble
