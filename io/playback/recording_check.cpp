#include "io/playback/recording_check.h"

#include <algorithm>
#include <filesystem>

#include "io/base/compressed_file.h"
#include "io/ros/ros_message_reader.h"

namespace rubble {
namespace {

bool begins_with(const std::string& path, std::string_view magic) {
  FileCursor file(path);
  return file.take(std::min<std::uint64_t>(file.size(), magic.size()), "") == magic;
}

}  // namespace

std::optional<RecordingCheck> check_recording(const std::string& path) {
  const std::string suffix = std::filesystem::path(path).extension().string();
  RecordingCheck check;
  const auto count = [&check](const RosMessage& message) {
    ++check.messages[std::string(message.topic)];
    return true;
  };
  if (suffix == ".bag" || begins_with(path, "#ROSBAG V2.0\n")) {
    check.kind = "ROS 1 bag";
    check.fault = read_bag(path, count);
  } else if (suffix == ".mcap" || begins_with(path, "\x89MCAP0\r\n")) {
    check.kind = "MCAP";
    check.fault = read_mcap(path, count);
  } else if (suffix == ".rawlog" || suffix == ".simplemap" || begins_with(path, "\x1f\x8b")) {
    check.kind = "gzip";
    check.fault = check_gzip(path);
  } else {
    return std::nullopt;
  }
  return check;
}

std::optional<FileFault> find_fault(const std::string& path) {
  const auto check = check_recording(path);
  return check ? check->fault : std::nullopt;
}

}  // namespace rubble
