#include "app/live.h"

#include <cstdio>

#include "app/stop.h"
#include "io/live/live_ros.h"

namespace rubble {
namespace {

void set_common(LiveOptions& live, const RunOptions& options) {
  live.rate = options.live.rate;
  live.wait = options.live.wait;
  live.stopped = stop_requested;
  if (options.quiet) return;
  live.notice = [](const std::string& line) {
    std::fprintf(stderr, "\nrubble: %s\n", line.c_str());
  };
}

Ros1Options ros1_options(const RunOptions& options) {
  Ros1Options ros1;
  set_common(ros1, options);
  ros1.master = options.live.ros_master;
  ros1.address = options.live.ros_ip;
  return ros1;
}

}  // namespace

void check_live(const RunOptions& options) {
  if (options.live.ros1) check_ros1(ros1_options(options));
}

void add_live_recorders(RecorderSet& set, const RunOptions& options, const RosOptions& ros) {
  if (options.live.ros1)
    set.recorders.push_back(
        make_ros_recorder("--ros1", make_ros1_stream(ros1_options(options)), ros));
}

std::unique_ptr<DriveStream> make_drive_stream(const RunOptions& options) {
  if (!options.live.ros1) return nullptr;
  Ros1Options ros1 = ros1_options(options);
  ros1.rate = 0;
  return make_ros1_drive(ros1);
}

}  // namespace rubble
