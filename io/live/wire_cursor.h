// Takes the fields of a message of ROS apart, as ros::Wire puts them together.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/base/little_endian.h"
#include "io/ros/ros_wire.h"
#include "kernel/base/error.h"
#include "kernel/base/math.h"

namespace rubble {

// Every function throws RunError, which names the type, where the bytes are no such message.
class WireCursor {
 public:
  // type: of the message, as errors name it. It and the message must outlive this.
  WireCursor(const char* type, ros::Version version, std::string_view message)
      : type_(type), version_(version), rest_(message) {
    if (version == ros::Version::ros1) return;
    const std::uint32_t encapsulation = number<std::uint32_t>();
    if ((encapsulation & 0xffff) != 0x0100) fail();  // little-endian CDR, as every rmw sends it
    start_ = rest_.data();
  }

  template <typename T>
  T number() {
    align(sizeof(T));
    T value{};
    if (!rubble::take(rest_, value)) fail();
    return value;
  }
  double finite() {
    const double value = number<double>();
    if (!std::isfinite(value)) fail();
    return value;
  }
  Vec3 vector() {
    const double x = finite(), y = finite(), z = finite();
    return {x, y, z};
  }
  // Of geometry_msgs/Pose or Transform; a rotation of another length than 1 is scaled to it.
  Pose pose() {
    const Vec3 place = vector();
    const double x = finite(), y = finite(), z = finite(), w = finite();
    const Quat rotation{w, x, y, z};
    if (!(x * x + y * y + z * z + w * w > 0.5)) fail();
    return {normalized(rotation), place};
  }
  std::string text() {
    const std::string_view text = blob(number<std::uint32_t>());
    return std::string(text.substr(0, text.find('\0')));  // ROS 2's end with it
  }
  std::string_view blob(std::size_t size) {
    if (size > rest_.size()) fail();
    const std::string_view bytes = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return bytes;
  }
  // Of a list, each of at least so many bytes.
  std::size_t count(std::size_t least) {
    const std::size_t size = number<std::uint32_t>();
    if (size > rest_.size() / least) fail();
    return size;
  }
  struct Header {
    std::int64_t stamp_ns = 0;
    std::string frame;
  };
  Header header() {
    if (version_ == ros::Version::ros1) number<std::uint32_t>();  // its sequence number
    const std::int64_t seconds = number<std::uint32_t>();
    const std::int64_t stamp = seconds * 1'000'000'000 + number<std::uint32_t>();
    return {stamp, text()};
  }
  double duration() {
    const double seconds = number<std::int32_t>();
    // Nanoseconds are signed in ROS 1 alone; both keep them below a second.
    return seconds + number<std::int32_t>() * 1e-9;
  }
  template <typename T>
  std::vector<T> list() {
    std::vector<T> values = raw_list<T>();
    for (const T& value : values)
      if (!std::isfinite(double(value))) fail();
    return values;
  }
  // Its numbers may be NaN or infinite.
  template <typename T>
  std::vector<T> raw_list() {
    std::vector<T> values(count(sizeof(T)));
    for (T& value : values) value = number<T>();
    return values;
  }
  // After the last field: at most the bytes that fill up a word may follow.
  void end() const {
    if (rest_.size() > 3) fail();
  }
  [[noreturn]] void fail() const {
    throw RunError(std::string("what came is no ") + type_ + " of finite numbers");
  }

 private:
  void align(std::size_t size) {
    if (!start_) return;
    const std::size_t over = std::size_t(rest_.data() - start_) % size;
    if (over && size - over > rest_.size()) fail();
    if (over) rest_.remove_prefix(size - over);
  }

  const char* type_;
  ros::Version version_;
  std::string_view rest_;
  const char* start_ = nullptr;  // of what CDR aligns by; none in ROS 1
};

}  // namespace rubble
