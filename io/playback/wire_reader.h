// ROS messages of a recording, field by field.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/ros/ros_message_reader.h"
#include "kernel/base/math.h"

namespace rubble {

// Takes a message's fields off its front, by the rules of ros_wire.h. After a field that is not whole, sound() is false
// and all further fields are 0 or empty.
class WireReader {
 public:
  explicit WireReader(const RosMessage& message)
      : cdr_(message.version == ros::Version::ros2),
        bytes_(message.bytes.substr(cdr_ ? std::min<std::size_t>(4, message.bytes.size()) : 0)) {}

  template <typename T>
  T number() {
    if (cdr_) skip((sizeof(T) - at_ % sizeof(T)) % sizeof(T));
    T value{};
    std::string_view left = bytes_.substr(at_);
    sound_ = sound_ && take(left, value);
    skip(sizeof value);
    return value;
  }
  std::string_view block() {
    const auto size = number<std::uint32_t>();
    const std::string_view found = bytes_.substr(at_, size);
    skip(size);
    return found;
  }
  std::string text() {
    std::string found(block());
    if (cdr_ && !found.empty()) found.pop_back();  // its NUL
    return found;
  }
  // Its stamp; unit: ns. The sequence number of ROS 1 and the frame are left out.
  std::int64_t header() {
    if (!cdr_) number<std::uint32_t>();
    const std::int64_t seconds = number<std::uint32_t>(), rest = number<std::uint32_t>();
    text();
    return seconds * 1'000'000'000 + rest;
  }
  Vec3 vector() {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = number<double>();
    return v;
  }
  // Position, then x, y, z, w.
  Pose pose() {
    Pose pose;
    pose.translation = vector();
    const Vec3 q = vector();
    pose.rotation = {number<double>(), q.x, q.y, q.z};
    return pose;
  }
  void skip_doubles(int count) {
    for (int i = 0; i < count; ++i) number<double>();
  }
  bool sound() const { return sound_; }

 private:
  void skip(std::size_t count) {
    sound_ = sound_ && count <= bytes_.size() - at_;
    at_ = sound_ ? at_ + count : bytes_.size();
  }

  bool cdr_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool sound_ = true;
};

}  // namespace rubble
