// The messages of a recording in the wire formats of ROS 1 and ROS 2, with the names, definitions
// and MD5 sums by which other programs know them. Quaternions go out in ROS's order, x y z w, here
// alone.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/ros/ros_wire.h"
#include "kernel/base/math.h"
#include "render/scene/frame.h"
#include "render/scene/range_scan.h"
#include "render/scene/robot_sample.h"

namespace rubble::ros {

inline constexpr char kWorld[] = "world";  // the fixed frame of every recording

struct MessageType {
  const char* package;      // "sensor_msgs"
  const char* name;         // ROS 1: "package/name"; ROS 2: "package/msg/name"
  const char* md5;          // ROS 1
  const char* definition1;  // of ROS 1, with all types in it
  const char* definition2;  // of ROS 2, as ros2msg
};
extern const MessageType kImage, kCompressedImage, kCameraInfo, kPoseStamped, kTfMessage, kClock,
    kImu, kEventArray, kString, kPointCloud, kLaserScan, kJointState, kOdometry, kWrenchStamped, kRange, kBool,
    kFluidPressure, kMagneticField, kNavSatFix, kLivoxScan, kBatteryState;

std::string type_name(const MessageType& type, Version version);

struct Header {
  std::uint32_t sequence = 0;  // ROS 1 alone
  std::int64_t stamp_ns = 0;   // simulation time; unit: ns
  std::string frame;           // frame_id
};

std::string clock(Version version, std::int64_t stamp_ns);
std::string string(Version version, std::string_view text);
// encoding: one of ROS's, such as "rgb8" or "32FC1", whose pixels `data` holds row by row,
// little-endian.
std::string image(Version version, const Header& header, const Intrinsics& intrinsics,
                  const std::string& encoding, int bytes_per_pixel, const void* data);
// `format` as image_transport writes it, such as "rgb8; jpeg compressed bgr8".
std::string compressed_image(Version version, const Header& header, const std::string& format,
                             std::string_view bytes);
// baseline: for the right camera of a pair, its distance from the left one (unit: m), which ROS
// keeps as P[3] = -fx * baseline; 0 otherwise.
std::string camera_info(Version version, const Header& header, const Intrinsics& intrinsics,
                        double baseline = 0);
std::string pose_stamped(Version version, const Header& header, const Pose& pose);
// Each takes coordinates of `child` to `parent`. What is latched must be one message: a late subscriber
// gets only the last.
struct Transform {
  std::string child;     // child_frame_id
  Pose pose;             // parent_from_child; unit: m
  std::string parent{};  // empty: the header's frame
};
std::string transforms(Version version, const Header& header, const std::vector<Transform>& list);
// Without an orientation, as REP 145 wants it of a unit that measures none. Variances: of one
// sample, the same for all axes; units: (rad/s)^2 and (m/s2)^2.
std::string imu(Version version, const Header& header, const ImuSample& sample,
                double angular_variance, double acceleration_variance);
// By joint; lists of one length.
std::string joint_state(Version version, const Header& header, const std::vector<std::string>& names,
                        const std::vector<double>& positions, const std::vector<double>& speeds,
                        const std::vector<double>& efforts);
// header.frame: the one that `pose` is in; velocities in the child's own. Exact: its variances are 1e-9,
// which filters can invert.
std::string true_odometry(Version version, const Header& header, const std::string& child, const Pose& pose,
                          const Vec3& linear, const Vec3& angular);
// What dead reckoning does not tell (height, roll, pitch) has the variance 1e6; no other is below 1e-6.
std::string odometry(Version version, const Header& header, const std::string& child, const RobotSample::Odometry& reading);
std::string wrench_stamped(Version version, const Header& header, const Vec3& force,
                           const Vec3& moment);
// What the sensors of scripting/sensors say. full_angle: unit: rad; ranges: unit: m; infinite as in REP 117.
std::string range(Version version, const Header& header, bool infrared, double full_angle, double min_range,
                  double max_range, double range);
std::string boolean(Version version, bool value);
// sensor_msgs/Imu with an orientation alone: what it does not measure has the covariance -1. variances: about the axes of
// the fixed frame; unit: rad2
std::string attitude(Version version, const Header& header, const Quat& orientation, const Vec3& variances);
std::string fluid_pressure(Version version, const Header& header, double pressure, double variance);  // unit: Pa
std::string magnetic_field(Version version, const Header& header, const Vec3& field, double variance);  // unit: T
// Without a fix: status -1, and what is not known is NaN. variances: east, north, up; unit: m2
std::string nav_sat_fix(Version version, const Header& header, bool fix, double latitude_deg, double longitude_deg,
                        double altitude, const Vec3& variances);
// While it discharges its current is negative; what is not known is NaN.
struct Battery {
  double voltage = 0, current = 0;  // current: that it gives; unit: V, A
  double charge = 0, capacity = 0;  // charge: share of the capacity; unit: 1, A h
  std::size_t cells = 1;            // lithium-ion, in series
};
std::string battery_state(Version version, const Header& header, const Battery& battery);
// dvs_msgs/EventArray, as drivers of event cameras publish.
std::string event_array(Version version, const Header& header, const Intrinsics& intrinsics,
                        const std::vector<Event>& events);

// Unordered, dense: x, y, z, intensity (float32), ring (uint16), time (float32, s since the stamp).
std::string point_cloud(Version version, const Header& header, const std::vector<ScanPoint>& points);
// As Ouster's driver writes them, and LIO-SAM and FAST-LIO read: x, y, z, intensity (float32), t (uint32, ns since the stamp),
// reflectivity (uint16), ring (uint8), ambient (uint16: 0), range (uint32, mm).
std::string ouster_cloud(Version version, const Header& header, const std::vector<ScanPoint>& points);
// livox_ros_driver2/CustomMsg.
std::string livox_scan(Version version, const Header& header, const std::vector<ScanPoint>& points);
// Of a planar pattern: a range for every column, inf where there is no echo (REP 117); of two echoes of a
// ray the first of the scan.
std::string laser_scan(Version version, const Header& header, const RangeScan& scan);

}  // namespace rubble::ros
