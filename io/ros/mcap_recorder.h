// A ROS 2 recording as an MCAP file, profile `ros2`; what is in it: io/ros/ros_recorder.h.
#pragma once

#include "io/ros/mcap_writer.h"
#include "io/ros/ros_recorder.h"

namespace rubble {

// threads: that compress, >= 1; the file does not depend on it. Throws RunError when `path` cannot
// be created.
std::unique_ptr<Recorder> make_mcap_recorder(const std::string& path,
                                             const RosOptions& options = {},
                                             McapCompression compression = McapCompression::zstd,
                                             int threads = recording_threads());

}  // namespace rubble
