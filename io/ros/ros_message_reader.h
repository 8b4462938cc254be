// ROS bags and MCAP files, read back message by message and looked over to the last byte: what
// `rubble info` and `rubble verify` know of a recording. That the writers are right is for readers
// of others to say, in the tests; these two have to know where a file stops being one.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "io/base/file_cursor.h"
#include "io/ros/ros_wire.h"

namespace rubble {

struct RosMessage {
  ros::Version version = ros::Version::ros1;  // of the wire format
  std::string_view topic;                     // with its leading slash
  std::string_view bytes;                     // on the wire
  std::string_view type = {};                 // of a bag: sensor_msgs/Image, "" where it says none; of MCAP: ""
};
// A message is valid during the call only. Returns whether to go on.
using TakeRosMessage = std::function<bool(const RosMessage&)>;

// Each walks through the whole file in its order, decompresses every chunk and compares every
// checksum that the format has (of an LZ4 chunk's content; of nearly all that is in an MCAP file),
// and what its index says with what is there. Nothing: the file is sound, or `take` had enough.
// Throws InputError when the file cannot be read, or is compressed in a way that Rubble does not
// write.
std::optional<FileFault> read_bag(const std::string& path, const TakeRosMessage& take);
std::optional<FileFault> read_mcap(const std::string& path, const TakeRosMessage& take);

}  // namespace rubble
