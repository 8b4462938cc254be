// A ROS 1 bag (format 2.0); what is in it: io/ros/ros_recorder.h.
#pragma once

#include "io/ros/bag_writer.h"
#include "io/ros/ros_recorder.h"

namespace rubble {

// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_rosbag_recorder(const std::string& path,
                                               const RosOptions& options = {},
                                               BagCompression compression = BagCompression::lz4);

}  // namespace rubble
