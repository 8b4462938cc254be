// Stands in for live_ros1.cpp in a build without roscpp.
#include "io/live/live_ros.h"
#include "kernel/base/error.h"

namespace rubble {

std::string describe_ros1() { return "not built in: needs Debian's libroscpp-dev, see docs/how_to/live.md"; }

void check_ros1(const Ros1Options&) {
  throw InputError({"", 0, "--ros1", "this program was built without ROS 1", "", "",
                    "install libroscpp-dev (all of it: `make live`) and build again"});
}

std::unique_ptr<RosFile> make_ros1_stream(const Ros1Options& options) {
  check_ros1(options);
  return nullptr;
}

std::unique_ptr<DriveStream> make_ros1_drive(const Ros1Options& options) {
  check_ros1(options);
  return nullptr;
}

}  // namespace rubble
