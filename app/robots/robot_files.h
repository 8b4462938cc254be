// What a run keeps of its robots, in the folder robots/.
#pragma once

#include <string>
#include <vector>

#include "app/robots/robot_log.h"
#include "app/scene/moving_scene.h"
#include "kernel/model/robot.h"
#include "kernel/robot/robot_run.h"

namespace rubble {

// Names of the files below the run's folder; of a folder, its name.
std::vector<std::string> robot_file_names(const std::vector<std::string>& robots,
                                          const std::vector<RobotModel>& models);

// robots/track.bin, robots/robots.json, robots/package.xml (for ROS), and of each robot NAME.txt (TUM: the base's
// true pose), NAME_joints.csv, NAME_odometry.csv where it has two driven sides, and NAME.urdf with the meshes in
// NAME_meshes/. start_ns: the stamp of the track's time 0. Throws RunError.
void write_robot_files(const std::string& folder, const std::vector<std::string>& names,
                       const RobotTrack& moved, const std::vector<RobotSummary>& summaries, int pieces_moved,
                       const std::vector<RobotLog>& logs, std::int64_t start_ns);

// NAME.urdf in that folder, and in NAME_meshes/ a mesh of each link and of each of its convex parts. Throws
// RunError.
void write_robot_description(const std::string& folder, const std::string& name, const RobotModel& model);

}  // namespace rubble
