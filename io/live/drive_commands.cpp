#include "io/live/drive_commands.h"

#include <cmath>

#include "io/base/little_endian.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// Takes the fields of a message apart, as ros::Wire puts them together.
class WireCursor {
 public:
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
  Vec3 vector() {
    const double x = number<double>(), y = number<double>(), z = number<double>();
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) fail();
    return {x, y, z};
  }
  void skip_text() {
    const std::size_t size = number<std::uint32_t>();
    if (size > rest_.size()) fail();
    rest_.remove_prefix(size);
  }
  template <typename T>
  std::vector<T> list() {
    const std::size_t count = number<std::uint32_t>();
    if (count > rest_.size() / sizeof(T)) fail();
    std::vector<T> values(count);
    for (T& value : values) {
      value = number<T>();
      if (!std::isfinite(double(value))) fail();
    }
    return values;
  }

 private:
  void align(std::size_t size) {
    if (!start_) return;
    const std::size_t over = std::size_t(rest_.data() - start_) % size;
    if (over && size - over > rest_.size()) fail();
    if (over) rest_.remove_prefix(size - over);
  }
  [[noreturn]] void fail() const {
    throw RunError(std::string("what came is no ") + type_ + " of finite numbers");
  }

  const char* type_;
  ros::Version version_;
  std::string_view rest_;
  const char* start_ = nullptr;  // of what CDR aligns by; none in ROS 1
};

}  // namespace

TwistCommand read_twist(ros::Version version, std::string_view message) {
  WireCursor cursor("geometry_msgs/Twist", version, message);
  const Vec3 linear = cursor.vector();
  return {linear, cursor.vector()};
}

JoyCommand read_joy(ros::Version version, std::string_view message) {
  WireCursor cursor("sensor_msgs/Joy", version, message);
  for (int i = 0; i < (version == ros::Version::ros1 ? 3 : 2); ++i) cursor.number<std::uint32_t>();
  cursor.skip_text();
  JoyCommand joy;
  joy.axes = cursor.list<float>();
  joy.buttons = cursor.list<std::int32_t>();
  return joy;
}

}  // namespace rubble
