#include "io/ros/ros_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernel/base/portable_math.h"

namespace rubble::ros {
namespace {

// sensor_msgs/PointField: its type numbers, and what a point holds.
constexpr std::uint8_t kUint8 = 2, kUint16 = 4, kUint32 = 6, kFloat32 = 7;
struct PointField {
  const char* name;
  std::uint32_t offset;  // unit: byte
  std::uint8_t type;
};
struct PointLayout {
  std::uint32_t step;  // of a point; unit: byte
  std::vector<PointField> fields;
};
const PointLayout kVelodyneLayout{22,
                                  {{"x", 0, kFloat32}, {"y", 4, kFloat32}, {"z", 8, kFloat32}, {"intensity", 12, kFloat32},
                                   {"ring", 16, kUint16}, {"time", 18, kFloat32}}};
const PointLayout kOusterLayout{48,
                                {{"x", 0, kFloat32}, {"y", 4, kFloat32}, {"z", 8, kFloat32}, {"intensity", 16, kFloat32},
                                 {"t", 20, kUint32}, {"reflectivity", 24, kUint16}, {"ring", 26, kUint8},
                                 {"ambient", 28, kUint16}, {"range", 32, kUint32}}};

template <typename T>
T clamped(double value) {
  return T(std::clamp(std::floor(value + 0.5), 0.0, double(std::numeric_limits<T>::max())));
}

void put_header(Wire& out, const Header& header) {
  if (out.version() == Version::ros1) out.number(header.sequence);
  out.time(header.stamp_ns);
  out.text(header.frame);
}

void put_vector(Wire& out, const Vec3& v) {
  for (int i = 0; i < 3; ++i) out.number(v[i]);
}

void put_pose(Wire& out, const Pose& pose) {
  put_vector(out, pose.translation);
  const Quat& q = pose.rotation;
  for (const double value : {q.x, q.y, q.z, q.w}) out.number(value);
}

void put_diagonal(Wire& out, double value) {
  for (int i = 0; i < 9; ++i) out.number(i % 4 == 0 ? value : 0.0);
}

std::size_t pixels_of(const Intrinsics& k) {
  return static_cast<std::size_t>(k.width) * static_cast<std::size_t>(k.height);
}

}  // namespace

std::string type_name(const MessageType& type, Version version) {
  return std::string(type.package) + (version == Version::ros1 ? "/" : "/msg/") + type.name;
}

std::string clock(Version version, std::int64_t stamp_ns) {
  Wire out(version);
  out.time(stamp_ns);
  return out.take();
}

std::string string(Version version, std::string_view text) {
  Wire out(version, text.size() + 16);
  out.text(text);
  return out.take();
}

std::string image(Version version, const Header& header, const Intrinsics& intrinsics,
                  const std::string& encoding, int bytes_per_pixel, const void* data) {
  const auto width = static_cast<std::uint32_t>(intrinsics.width);
  const auto step = width * static_cast<std::uint32_t>(bytes_per_pixel);
  const std::size_t size = pixels_of(intrinsics) * static_cast<std::size_t>(bytes_per_pixel);
  Wire out(version, size + 128);
  put_header(out, header);
  out.number(static_cast<std::uint32_t>(intrinsics.height));
  out.number(width);
  out.text(encoding);
  out.boolean(false);  // is_bigendian
  out.number(step);
  out.blob({static_cast<const char*>(data), size});
  return out.take();
}

std::string compressed_image(Version version, const Header& header, const std::string& format,
                             std::string_view bytes) {
  Wire out(version, bytes.size() + 128);
  put_header(out, header);
  out.text(format);
  out.blob(bytes);
  return out.take();
}

std::string camera_info(Version version, const Header& header, const Intrinsics& intrinsics,
                        double baseline) {
  const Intrinsics& k = intrinsics;
  Wire out(version, 512);
  put_header(out, header);
  out.number(static_cast<std::uint32_t>(k.height));
  out.number(static_cast<std::uint32_t>(k.width));
  const bool fisheye = k.lens == LensModel::fisheye;
  out.text(fisheye ? "equidistant" : "plumb_bob");
  const std::size_t coefficients = fisheye ? 4 : k.distortion.size();
  out.count(coefficients);
  for (std::size_t i = 0; i < coefficients; ++i) out.number(k.distortion[i]);
  for (const double v : {k.fx, 0.0, k.cx, 0.0, k.fy, k.cy, 0.0, 0.0, 1.0}) out.number(v);
  for (const double v : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) out.number(v);
  const double shift = baseline == 0 ? 0.0 : -k.fx * baseline;
  for (const double v : {k.fx, 0.0, k.cx, shift, 0.0, k.fy, k.cy, 0.0, 0.0, 0.0, 1.0, 0.0})
    out.number(v);
  for (int i = 0; i < 6; ++i) out.number(std::uint32_t{0});  // no binning, no region of interest
  out.boolean(false);                                        // do_rectify
  return out.take();
}

std::string pose_stamped(Version version, const Header& header, const Pose& pose) {
  Wire out(version);
  put_header(out, header);
  put_pose(out, pose);
  return out.take();
}

std::string transforms(Version version, const Header& header, const std::vector<Transform>& list) {
  Wire out(version);
  out.count(list.size());
  for (const Transform& transform : list) {
    Header from = header;
    if (!transform.parent.empty()) from.frame = transform.parent;
    put_header(out, from);
    out.text(transform.child);
    put_pose(out, transform.pose);
  }
  return out.take();
}

std::string imu(Version version, const Header& header, const ImuSample& sample,
                double angular_variance, double acceleration_variance) {
  Wire out(version, 384);
  put_header(out, header);
  for (const double value : {0.0, 0.0, 0.0, 1.0}) out.number(value);
  for (int i = 0; i < 9; ++i) out.number(i == 0 ? -1.0 : 0.0);  // -1: no orientation
  put_vector(out, sample.angular_velocity);
  put_diagonal(out, angular_variance);
  put_vector(out, sample.linear_acceleration);
  put_diagonal(out, acceleration_variance);
  return out.take();
}

namespace {

// put(point, to): writes a point of layout.step bytes.
template <typename Put>
std::string cloud(Version version, const Header& header, const std::vector<ScanPoint>& points, const PointLayout& layout, const Put& put) {
  const auto count = static_cast<std::uint32_t>(points.size());
  std::string data(points.size() * layout.step, '\0');
  for (std::size_t i = 0; i < points.size(); ++i) put(points[i], data.data() + i * layout.step);
  Wire out(version, data.size() + 512);
  put_header(out, header);
  out.number(std::uint32_t{1});
  out.number(count);
  out.count(layout.fields.size());
  for (const PointField& field : layout.fields) {
    out.text(field.name);
    out.number(field.offset);
    out.number(field.type);
    out.number(std::uint32_t{1});
  }
  out.boolean(false);  // is_bigendian
  out.number(layout.step);
  out.number(count * layout.step);
  out.blob(data);
  out.boolean(true);  // is_dense
  return out.take();
}

template <typename T>
void put_value(char* to, std::uint32_t offset, const T& value) {
  std::memcpy(to + offset, &value, sizeof value);
}

}  // namespace

std::string point_cloud(Version version, const Header& header, const std::vector<ScanPoint>& points) {
  return cloud(version, header, points, kVelodyneLayout, [](const ScanPoint& p, char* to) {
    const float place[] = {p.x, p.y, p.z, p.intensity};
    put_value(to, 0, place);
    put_value(to, 16, p.ring);
    put_value(to, 18, p.time);
  });
}

std::string ouster_cloud(Version version, const Header& header, const std::vector<ScanPoint>& points) {
  return cloud(version, header, points, kOusterLayout, [](const ScanPoint& p, char* to) {
    const float place[] = {p.x, p.y, p.z};
    const double range = std::sqrt(double(p.x) * p.x + double(p.y) * p.y + double(p.z) * p.z);
    put_value(to, 0, place);
    put_value(to, 16, p.intensity);
    put_value(to, 20, clamped<std::uint32_t>(double(p.time) * 1e9));
    put_value(to, 24, clamped<std::uint16_t>(double(p.intensity)));
    put_value(to, 26, clamped<std::uint8_t>(p.ring));
    put_value(to, 32, clamped<std::uint32_t>(range * 1000));
  });
}

std::string livox_scan(Version version, const Header& header, const std::vector<ScanPoint>& points) {
  Wire out(version, points.size() * 20 + 128);
  put_header(out, header);
  out.number(static_cast<std::uint64_t>(header.stamp_ns));  // of the first point
  out.number(static_cast<std::uint32_t>(points.size()));
  for (int i = 0; i < 4; ++i) out.number(std::uint8_t{0});  // lidar_id, rsvd
  out.count(points.size());
  for (const ScanPoint& p : points) {
    out.number(clamped<std::uint32_t>(double(p.time) * 1e9));
    out.number(p.x), out.number(p.y), out.number(p.z);
    out.number(clamped<std::uint8_t>(double(p.intensity)));
    out.number(std::uint8_t{0x10});  // tag: one echo, of high confidence
    out.number(clamped<std::uint8_t>(p.ring));
  }
  return out.take();
}

std::string laser_scan(Version version, const Header& header, const RangeScan& scan) {
  const auto& spec = *scan.spec;
  const auto columns = static_cast<std::size_t>(spec.columns);
  std::vector<float> ranges(columns, std::numeric_limits<float>::infinity()), intensities(columns, 0);
  for (auto p = scan.points.rbegin(); p != scan.points.rend(); ++p) {
    ranges.at(p->column) = std::sqrt(p->x * p->x + p->y * p->y + p->z * p->z);
    intensities[p->column] = p->intensity;
  }
  constexpr double kRadian = portable::kPi / 180;
  const double first = spec.first_azimuth_deg * kRadian, step = spec.span_deg * kRadian / spec.columns;
  Wire out(version, 8 * columns + 256);
  put_header(out, header);
  for (const double value : {first, first + step * (spec.columns - 1), step, double(spec.column_ns) * 1e-9,
                             1 / spec.rate_hz, spec.min_range, spec.max_range})
    out.number(static_cast<float>(value));
  for (const auto* values : {&ranges, &intensities}) {
    out.count(columns);
    for (const float value : *values) out.number(value);
  }
  return out.take();
}

std::string joint_state(Version version, const Header& header, const std::vector<std::string>& names,
                        const std::vector<double>& positions, const std::vector<double>& speeds,
                        const std::vector<double>& efforts) {
  Wire out(version, 64 + 56 * names.size());
  put_header(out, header);
  out.count(names.size());
  for (const std::string& name : names) out.text(name);
  for (const auto* list : {&positions, &speeds, &efforts}) {
    out.count(list->size());
    for (const double value : *list) out.number(value);
  }
  return out.take();
}

namespace {

using Covariance = std::array<std::array<double, 6>, 6>;  // x, y, z, and turns about them

std::string put_odometry(Version version, const Header& header, const std::string& child, const Pose& pose,
                         const Covariance& of_pose, const Vec3& linear, const Vec3& angular, const Covariance& of_twist) {
  Wire out(version, 800);
  put_header(out, header);
  out.text(child);
  put_pose(out, pose);
  for (const auto& row : of_pose)
    for (const double value : row) out.number(value);
  put_vector(out, linear);
  put_vector(out, angular);
  for (const auto& row : of_twist)
    for (const double value : row) out.number(value);
  return out.take();
}

// Variances in SI units. Of the truth it is not 0: filters cannot invert that, and readers take it for an unknown one.
constexpr double kUnknown = 1e6, kLeast = 1e-6, kExact = 1e-9;

Covariance unknown_out_of_plane() {
  Covariance covariance{};
  for (const std::size_t axis : {2, 3, 4}) covariance[axis][axis] = kUnknown;
  return covariance;
}

}  // namespace

std::string true_odometry(Version version, const Header& header, const std::string& child, const Pose& pose,
                          const Vec3& linear, const Vec3& angular) {
  Covariance exact{};
  for (std::size_t axis = 0; axis < 6; ++axis) exact[axis][axis] = kExact;
  return put_odometry(version, header, child, pose, exact, linear, angular, exact);
}

std::string odometry(Version version, const Header& header, const std::string& child, const RobotSample::Odometry& o) {
  constexpr std::size_t kAxes[3] = {0, 1, 5};  // x, y, yaw
  Covariance of_pose = unknown_out_of_plane(), of_twist = unknown_out_of_plane();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) of_pose[kAxes[i]][kAxes[j]] = o.covariance[i][j];
    of_pose[kAxes[i]][kAxes[i]] += kLeast;
  }
  of_twist[0][0] = of_twist[1][1] = o.linear_variance + kLeast;  // sideways as forwards: it slips there, too
  of_twist[5][5] = o.angular_variance + kLeast;
  return put_odometry(version, header, child, o.odom_from_base, of_pose, {o.linear, 0, 0}, {0, 0, o.angular}, of_twist);
}

std::string wrench_stamped(Version version, const Header& header, const Vec3& force,
                           const Vec3& moment) {
  Wire out(version, 128);
  put_header(out, header);
  put_vector(out, force);
  put_vector(out, moment);
  return out.take();
}

std::string range(Version version, const Header& header, bool infrared, double full_angle, double min_range,
                  double max_range, double range) {
  Wire out(version, 64);
  put_header(out, header);
  out.number(std::uint8_t(infrared));  // INFRARED is 1, ULTRASOUND 0
  for (const double value : {full_angle, min_range, max_range, range}) out.number(static_cast<float>(value));
  return out.take();
}

std::string boolean(Version version, bool value) {
  Wire out(version, 8);
  out.boolean(value);
  return out.take();
}

std::string attitude(Version version, const Header& header, const Quat& q, const Vec3& variances) {
  Wire out(version, 384);
  put_header(out, header);
  for (const double value : {q.x, q.y, q.z, q.w}) out.number(value);
  for (int i = 0; i < 9; ++i) out.number(i % 4 == 0 ? variances[i / 4] : 0.0);
  for (int unknown = 0; unknown < 2; ++unknown) {
    put_vector(out, {});
    for (int i = 0; i < 9; ++i) out.number(i == 0 ? -1.0 : 0.0);
  }
  return out.take();
}

std::string fluid_pressure(Version version, const Header& header, double pressure, double variance) {
  Wire out(version, 64);
  put_header(out, header);
  out.number(pressure);
  out.number(variance);
  return out.take();
}

std::string magnetic_field(Version version, const Header& header, const Vec3& field, double variance) {
  Wire out(version, 160);
  put_header(out, header);
  put_vector(out, field);
  put_diagonal(out, variance);
  return out.take();
}

std::string nav_sat_fix(Version version, const Header& header, bool fix, double latitude_deg, double longitude_deg,
                        double altitude, const Vec3& variances) {
  constexpr std::uint16_t kGps = 1;
  constexpr std::uint8_t kUnknownCovariance = 0, kDiagonal = 2;
  Wire out(version, 192);
  put_header(out, header);
  out.number(std::int8_t(fix ? 0 : -1));
  out.number(kGps);
  for (const double value : {latitude_deg, longitude_deg, altitude}) out.number(value);
  for (int i = 0; i < 9; ++i) out.number(fix && i % 4 == 0 ? variances[i / 4] : 0.0);
  out.number(fix ? kDiagonal : kUnknownCovariance);
  return out.take();
}

std::string battery_state(Version version, const Header& header, const Battery& battery) {
  constexpr std::uint8_t kDischarging = 2, kNotCharging = 3, kGood = 1, kDead = 3, kLithiumIon = 2;
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const bool empty = battery.charge <= 0;
  Wire out(version, 160);
  put_header(out, header);
  for (const double value : {battery.voltage, double(kUnknown), battery.current > 0 ? -battery.current : 0.0, battery.charge * battery.capacity,
                             battery.capacity, battery.capacity, battery.charge})
    out.number(static_cast<float>(value));
  out.number(battery.current > 0 ? kDischarging : kNotCharging);
  out.number(empty ? kDead : kGood);
  out.number(kLithiumIon);
  out.boolean(true);  // present
  for (const double value : {battery.voltage / double(battery.cells), double(kUnknown)}) {
    out.count(battery.cells);
    for (std::size_t i = 0; i < battery.cells; ++i) out.number(static_cast<float>(value));
  }
  out.text("");  // location
  out.text("");  // serial_number
  return out.take();
}

std::string event_array(Version version, const Header& header, const Intrinsics& intrinsics,
                        const std::vector<Event>& events) {
  Wire out(version, 128 + 16 * events.size());
  put_header(out, header);
  out.number(static_cast<std::uint32_t>(intrinsics.height));
  out.number(static_cast<std::uint32_t>(intrinsics.width));
  out.count(events.size());
  for (const Event& event : events) {
    out.number(event.x);
    out.number(event.y);
    out.time(event.stamp_ns);
    out.boolean(event.brighter);
  }
  return out.take();
}

}  // namespace rubble::ros
