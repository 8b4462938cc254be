// Trajectories in files: what SLAM programs write and what ours writes as ground truth.
#pragma once

#include <string>
#include <vector>

#include "scripting/trajectory/trajectory_text.h"

namespace rubble {

// parse_trajectory() of a file. Throws InputError with file and line.
RecordedTrajectory load_recorded_trajectory(const std::string& path, const std::string& columns = "");

// Gives a track without stamps, as of KITTI, those of KITTI's times.txt: one a line, in s. Throws InputError with file and
// line: not a number, stamps that do not rise, another number of lines than poses.
void stamp_poses(const std::string& times, const std::string& path, RecordedTrajectory& track);

// Its poses alone.
std::vector<StampedPose> load_trajectory(const std::string& path);

}  // namespace rubble
