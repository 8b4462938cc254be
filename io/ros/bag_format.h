// What the reader and the writer of ROS bags share: http://wiki.ros.org/Bags/Format/2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace rubble::bag {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

// The kinds of records.
constexpr std::uint8_t kMessageData = 2, kFileHeader = 3, kIndexData = 4, kChunk = 5,
                       kChunkInfo = 6, kConnection = 7;

}  // namespace rubble::bag
