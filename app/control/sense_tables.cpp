#include "app/control/sense_tables.h"

#include <cmath>
#include <limits>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

Value vector_value(const Vec3& v) {
  Value list = Value::make_table();
  for (int i = 0; i < 3; ++i) list.items.push_back(Value::make_number(v[i]));
  return list;
}

Value describe_stamp(std::int64_t stamp_ns, std::int64_t start_ns) {
  return Value::make_number(double(stamp_ns - start_ns) * 1e-9);
}

// One number of each point.
template <typename Of>
Value describe_points(const RangeScan& scan, Of of) {
  Value list = Value::make_table();
  list.items.reserve(scan.points.size());
  for (const ScanPoint& point : scan.points) list.items.push_back(of(point));
  return list;
}

// A range for each ray of a scanner in one plane; infinite: no echo. Of two echoes the stronger, which comes first.
Value describe_ranges(const RangeScan& scan) {
  std::vector<double> ranges(std::size_t(scan.spec->columns), std::numeric_limits<double>::infinity());
  for (const ScanPoint& p : scan.points) {
    double& range = ranges[p.column];
    if (std::isinf(range)) range = norm(Vec3(p.x, p.y, p.z));
  }
  Value list = Value::make_table();
  list.items.reserve(ranges.size());
  for (const double range : ranges) list.items.push_back(Value::make_number(range));
  return list;
}

}  // namespace

Value describe_odometry(const OdometryReading& reading) {
  Value odometry = Value::make_table();
  odometry.set("x", Value::make_number(reading.x));
  odometry.set("y", Value::make_number(reading.y));
  odometry.set("yaw", Value::make_number(reading.yaw));
  odometry.set("linear", Value::make_number(reading.linear));
  odometry.set("angular", Value::make_number(reading.angular));
  return odometry;
}

Value describe_sense(const RobotSense& sense, const RobotKind& kind, const RobotModel& model, double gravity, Vec3& last,
                     double& last_time) {
  Value table = Value::make_table();
  table.set("t", Value::make_number(sense.time));
  Value joints = Value::make_table();
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].motor.effort <= 0) continue;
    const RobotState::Joint& from = sense.state.joints[i];
    Value joint = Value::make_table();
    joint.set("name", Value::make_text(model.joints[i].name));
    joint.set("position", Value::make_number(from.position));
    joint.set("speed", Value::make_number(from.speed));
    joint.set("torque", Value::make_number(from.torque));
    joints.items.push_back(joint);
  }
  table.set("joints", joints);
  const RobotState::Link& base = sense.state.links[0];
  const Quat to_base = base.world_from_link.rotation.conjugate();
  const double dt = sense.time - last_time;
  const Vec3 acceleration = dt > 0 ? (base.linear - last) * (1 / dt) : Vec3{};
  Value imu = Value::make_table();
  imu.set("gyroscope", vector_value(to_base.rotate(base.angular)));
  imu.set("accelerometer", vector_value(to_base.rotate(acceleration + Vec3{0, 0, gravity})));
  table.set("imu", imu);
  last = base.linear;
  last_time = sense.time;
  Value contacts = Value::make_table();
  for (const RobotContact& c : sense.contacts) {
    Value contact = Value::make_table();
    contact.set("link", Value::make_text(model.links[std::size_t(c.link)].name));
    contact.set("force", Value::make_number(c.force));
    contact.set("normal", vector_value(to_base.rotate(c.normal)));
    contacts.items.push_back(contact);
  }
  table.set("contacts", contacts);
  Value truth = Value::make_table();
  const Vec3 x = base.world_from_link.rotation.rotate({1, 0, 0});
  truth.set("position", vector_value(base.world_from_link.translation));
  truth.set("yaw", Value::make_number(portable::atan2(x.y, x.x)));
  kind.tell(sense.state, table, truth);
  table.set("truth", truth);
  return table;
}

namespace {

void describe_scan(const RangeScan& scan, Value& table) {
  const auto& spec = *scan.spec;
  if (spec.planar()) {
    constexpr double kRadians = portable::kPi / 180;
    table.set("ranges", describe_ranges(scan));
    table.set("first_angle", Value::make_number(spec.first_azimuth_deg * kRadians));
    table.set("angle_step", Value::make_number(spec.span_deg * kRadians / spec.columns));
    return;
  }
  table.set("x", describe_points(scan, [](const ScanPoint& p) { return Value::make_number(p.x); }));
  table.set("y", describe_points(scan, [](const ScanPoint& p) { return Value::make_number(p.y); }));
  table.set("z", describe_points(scan, [](const ScanPoint& p) { return Value::make_number(p.z); }));
  table.set("intensity", describe_points(scan, [](const ScanPoint& p) { return Value::make_number(p.intensity); }));
  table.set("ring", describe_points(scan, [](const ScanPoint& p) { return Value::make_integer(p.ring); }));
}

// Of a picture, without its pixels.
Value describe_frame(const Frame& frame, std::int64_t start_ns) {
  Value table = Value::make_table();
  table.set("t", describe_stamp(frame.stamp_ns, start_ns));
  table.set("width", Value::make_integer(frame.intrinsics.width));
  table.set("height", Value::make_integer(frame.intrinsics.height));
  return table;
}

}  // namespace

Value describe_reading(const ImuSample& reading, std::int64_t start_ns) {
  Value table = Value::make_table();
  table.set("t", describe_stamp(reading.stamp_ns, start_ns));
  table.set("gyroscope", vector_value(reading.angular_velocity));
  table.set("accelerometer", vector_value(reading.linear_acceleration));
  return table;
}

Value describe_values(const Reading& reading, const SensorItem& sensor, std::int64_t start_ns) {
  Value table = Value::make_table();
  table.set("t", describe_stamp(reading.stamp_ns, start_ns));
  if (reading.scan) describe_scan(*reading.scan, table);
  const std::vector<ReadingColumn> columns = sensor.figures->columns();
  for (std::size_t i = 0; i < columns.size(); ++i) table.set(columns[i].name, Value::make_number(reading.values[i]));
  return table;
}

Value describe_depth(const Frame& frame, std::int64_t start_ns) {
  Value depth = Value::make_table();
  depth.items.reserve(frame.depth.size());
  for (const float d : frame.depth)
    depth.items.push_back(Value::make_number(std::isnan(d) ? std::numeric_limits<double>::infinity() : double(d)));
  Value table = describe_frame(frame, start_ns);
  table.set("depth", std::move(depth));
  return table;
}

Value describe_colours(const Frame& frame, std::int64_t start_ns) {
  Value table = describe_frame(frame, start_ns);
  table.set("rgb", Value::make_text(std::string(frame.rgb.begin(), frame.rgb.end())));
  return table;
}

}  // namespace rubble
