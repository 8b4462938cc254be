#include "io/live/robot_messages.h"

#include <cmath>
#include <cstring>

#include "io/live/wire_cursor.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

// Type numbers of sensor_msgs/PointField.
constexpr std::uint8_t kUint32Field = 6, kFloat32Field = 7, kFloat64Field = 8;

// Where a number lies in a point.
struct FieldPlace {
  std::uint32_t offset = 0;  // unit: byte
  std::uint8_t type = 0;     // 0: there is none

  std::size_t size() const { return type == kFloat64Field ? 8 : 4; }
  double read(const char* point) const {
    if (type == 0) return 0;
    if (type == kFloat64Field) return get<double>(point);
    return type == kUint32Field ? 1e-9 * get<std::uint32_t>(point) : double(get<float>(point));
  }

 private:
  template <typename T>
  T get(const char* point) const {
    T value{};
    std::memcpy(&value, point + offset, sizeof value);
    return value;
  }
};

struct PointLayout {
  FieldPlace x, y, z, time;
};

PointLayout read_layout(WireCursor& cursor) {
  PointLayout layout;
  for (std::size_t i = cursor.count(13); i > 0; --i) {
    const std::string name = cursor.text();
    FieldPlace field{cursor.number<std::uint32_t>(), cursor.number<std::uint8_t>()};
    cursor.number<std::uint32_t>();  // how many
    const bool real = field.type == kFloat32Field || field.type == kFloat64Field;
    if (name == "x" && real) layout.x = field;
    if (name == "y" && real) layout.y = field;
    if (name == "z" && real) layout.z = field;
    if ((name == "time" || name == "t") && (real || field.type == kUint32Field)) layout.time = field;
  }
  return layout;
}

std::string without_slash(const std::string& frame) {
  return frame.empty() || frame[0] != '/' ? frame : frame.substr(1);
}

HeardCloud begin_cloud(WireCursor& cursor) {
  const WireCursor::Header header = cursor.header();
  HeardCloud cloud;
  cloud.stamp_ns = header.stamp_ns, cloud.frame = without_slash(header.frame);
  return cloud;
}

void add_point(double x, double y, double z, double time, HeardCloud& cloud) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z) || !std::isfinite(time))
    ++cloud.left_out;
  else
    cloud.points.push_back({{float(x), float(y), float(z)}, float(time)});
}

}  // namespace

HeardOdometry read_odometry(ros::Version version, std::string_view message) {
  WireCursor cursor("nav_msgs/Odometry", version, message);
  const WireCursor::Header header = cursor.header();
  const std::string child = without_slash(cursor.text());
  return {header.stamp_ns, without_slash(header.frame), child, cursor.pose()};
}

std::vector<HeardTransform> read_transforms(ros::Version version, std::string_view message) {
  WireCursor cursor("tf2_msgs/TFMessage", version, message);
  std::vector<HeardTransform> transforms;
  for (std::size_t i = cursor.count(72); i > 0; --i) {
    const WireCursor::Header header = cursor.header();
    const std::string child = without_slash(cursor.text());
    transforms.push_back({header.stamp_ns, without_slash(header.frame), child, cursor.pose()});
  }
  return transforms;
}

HeardCloud read_point_cloud(ros::Version version, std::string_view message) {
  WireCursor cursor("sensor_msgs/PointCloud2", version, message);
  HeardCloud cloud = begin_cloud(cursor);
  const std::size_t height = cursor.number<std::uint32_t>(), width = cursor.number<std::uint32_t>();
  const PointLayout layout = read_layout(cursor);
  const bool big_endian = cursor.number<std::uint8_t>() != 0;
  const std::size_t step = cursor.number<std::uint32_t>(), row = cursor.number<std::uint32_t>();
  const std::string_view data = cursor.blob(cursor.number<std::uint32_t>());
  const bool has_places = layout.x.type && layout.y.type && layout.z.type;
  if (big_endian || !has_places || (height > 0 && (row < step * width || data.size() / height < row))) cursor.fail();
  for (const FieldPlace& field : {layout.x, layout.y, layout.z, layout.time})
    if (field.type && field.offset + field.size() > step) cursor.fail();
  for (std::size_t y = 0; width > 0 && y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const char* const point = data.data() + y * row + x * step;
      add_point(layout.x.read(point), layout.y.read(point), layout.z.read(point), layout.time.read(point), cloud);
    }
  return cloud;
}

HeardCloud read_laser_scan(ros::Version version, std::string_view message) {
  WireCursor cursor("sensor_msgs/LaserScan", version, message);
  HeardCloud cloud = begin_cloud(cursor);
  float numbers[7];  // angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max
  for (float& number : numbers) number = cursor.number<float>();
  const double first = double(numbers[0]), step = double(numbers[2]), pause = double(numbers[3]);
  const std::vector<float> ranges = cursor.raw_list<float>();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double range = double(ranges[i]), angle = first + step * double(i);
    const bool echo = ranges[i] >= numbers[5] && ranges[i] <= numbers[6];
    if (!echo && !std::isnan(range)) continue;
    if (!std::isfinite(angle) || std::fabs(angle) > 1e6) cursor.fail();
    add_point(range * portable::cos(angle), range * portable::sin(angle), 0, pause * double(i), cloud);
  }
  return cloud;
}

}  // namespace rubble
