// What a run keeps of its robots, in the folder robots/.
#pragma once

#include <string>
#include <vector>

#include "kernel/model/robot.h"
#include "kernel/robot/robot_run.h"

namespace rubble {

// Joints of one robot at the samples of the track.
struct JointLog {
  std::vector<double> times;                           // of the track, rising; unit: s
  std::vector<std::vector<RobotState::Joint>> joints;  // by time, by joint
};

// Names of the files below the run's folder.
std::vector<std::string> robot_file_names(const std::vector<std::string>& robots);

// robots/track.bin, robots/robots.json, and of each robot NAME.txt (TUM: the base's true pose) and
// NAME_joints.csv. start_ns: the stamp of the track's time 0. Throws RunError.
void write_robot_files(const std::string& folder, const std::vector<std::string>& names,
                       const std::vector<RobotModel>& models, const RobotRunResult& result,
                       const std::vector<JointLog>& joints, std::int64_t start_ns);

}  // namespace rubble
