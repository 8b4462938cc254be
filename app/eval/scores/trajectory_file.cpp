#include "app/eval/scores/trajectory_file.h"

#include "io/base/atomic_file.h"

namespace rubble {

RecordedTrajectory load_recorded_trajectory(const std::string& path, const std::string& columns) {
  return parse_trajectory(read_whole_file(path), path, columns);
}

std::vector<StampedPose> load_trajectory(const std::string& path) { return load_recorded_trajectory(path).poses; }

}  // namespace rubble
