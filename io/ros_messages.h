// The ROS 1 messages of a recording, in ROS's wire format, with the names, definitions and MD5 sums
// by which other programs know them. Quaternions go out in ROS's order, x y z w, here alone.
#pragma once

#include <cstdint>
#include <string>

#include "kernel/base/math.h"
#include "render/frame.h"

namespace rubble::ros {

struct MessageType {
  const char* name;
  const char* md5;
  const char* definition;
};
extern const MessageType kImage, kCameraInfo, kPoseStamped, kTfMessage, kClock;

struct Header {
  std::uint32_t sequence = 0;
  std::int64_t stamp_ns = 0;
  std::string frame;
};

std::string clock(std::int64_t stamp_ns);
// encoding: "rgb8", "16UC1" or "32FC1", whose pixels `data` holds row by row, little-endian.
std::string image(const Header& header, const Intrinsics& intrinsics, const std::string& encoding,
                  int bytes_per_pixel, const void* data);
std::string camera_info(const Header& header, const Intrinsics& intrinsics);
std::string pose_stamped(const Header& header, const Pose& pose);
// One transform: takes coordinates of `child` to the header's frame.
std::string transform(const Header& header, const std::string& child, const Pose& pose);

}  // namespace rubble::ros
