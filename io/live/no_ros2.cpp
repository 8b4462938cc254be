// Stands in for live_ros2.cpp in a build without Cyclone DDS.
#include "io/live/live_ros.h"
#include "kernel/base/error.h"

namespace rubble {

std::string describe_ros2() { return "not built in: needs Debian's cyclonedds-dev, see docs/how_to/live.md"; }

void check_ros2(const Ros2Options&) {
  throw InputError({"", 0, "--ros2", "this program was built without ROS 2", "", "",
                    "install cyclonedds-dev (all of it: `make live`) and build again"});
}

std::unique_ptr<RosFile> make_ros2_stream(const Ros2Options& options) {
  check_ros2(options);
  return nullptr;
}

std::unique_ptr<DriveStream> make_ros2_drive(const Ros2Options& options) {
  check_ros2(options);
  return nullptr;
}

std::unique_ptr<LiveServer> make_ros2_server(const Ros2Options& options) {
  check_ros2(options);
  return nullptr;
}

}  // namespace rubble
