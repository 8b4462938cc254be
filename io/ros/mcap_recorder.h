// A ROS 2 recording as an MCAP file, profile `ros2`; what is in it: io/ros/ros_recorder.h. metadata.yaml beside it makes
// its folder a bag of rosbag2: `ros2 bag info FOLDER`, `ros2 bag play FOLDER`.
#pragma once

#include "io/ros/mcap_writer.h"
#include "io/ros/ros_recorder.h"

namespace rubble {

inline constexpr char kBagMetadata[] = "metadata.yaml";  // in the folder of the file

// threads: that compress, >= 1; the file does not depend on it. Throws RunError when `path` cannot
// be created.
std::unique_ptr<Recorder> make_mcap_recorder(const std::string& path,
                                             const RosOptions& options = {},
                                             McapCompression compression = McapCompression::zstd,
                                             int threads = recording_threads());

}  // namespace rubble
