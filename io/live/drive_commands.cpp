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
  std::string text() {
    const std::size_t size = number<std::uint32_t>();
    if (size > rest_.size()) fail();
    const std::string_view text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return std::string(text.substr(0, text.find('\0')));  // ROS 2's end with it
  }
  // Of a list, each of at least so many bytes.
  std::size_t count(std::size_t least) {
    const std::size_t size = number<std::uint32_t>();
    if (size > rest_.size() / least) fail();
    return size;
  }
  void skip_header() {
    for (int i = 0; i < (version_ == ros::Version::ros1 ? 3 : 2); ++i) number<std::uint32_t>();
    text();
  }
  double duration() {
    const double seconds = number<std::int32_t>();
    // Nanoseconds are signed in ROS 1 alone; both keep them below a second.
    return seconds + number<std::int32_t>() * 1e-9;
  }
  template <typename T>
  std::vector<T> list() {
    std::vector<T> values(count(sizeof(T)));
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
  cursor.skip_header();
  JoyCommand joy;
  joy.axes = cursor.list<float>();
  joy.buttons = cursor.list<std::int32_t>();
  return joy;
}

JointTrajectoryCommand read_joint_trajectory(ros::Version version, std::string_view message) {
  WireCursor cursor("trajectory_msgs/JointTrajectory", version, message);
  cursor.skip_header();
  JointTrajectoryCommand trajectory;
  for (std::size_t i = cursor.count(4); i > 0; --i) trajectory.joints.push_back(cursor.text());
  for (std::size_t i = cursor.count(24); i > 0; --i) {
    JointTrajectoryCommand::Point point;
    point.positions = cursor.list<double>();
    point.velocities = cursor.list<double>();
    for (int other = 0; other < 2; ++other) cursor.list<double>();  // accelerations, efforts
    point.time = cursor.duration();
    trajectory.points.push_back(std::move(point));
  }
  return trajectory;
}

}  // namespace rubble
