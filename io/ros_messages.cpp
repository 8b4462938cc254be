#include "io/ros_messages.h"

#include <string_view>

#include "io/little_endian.h"

namespace rubble::ros {
namespace {

#define RUBBLE_ROS_SECTION(type)                                                                 \
  "================================================================================\nMSG: " type \
  "\n"
#define RUBBLE_ROS_HEADER \
  RUBBLE_ROS_SECTION("std_msgs/Header") "uint32 seq\ntime stamp\nstring frame_id\n"
#define RUBBLE_ROS_QUATERNION \
  RUBBLE_ROS_SECTION("geometry_msgs/Quaternion") "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"

void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

void put_time(std::string& out, std::int64_t stamp_ns) {
  put(out, static_cast<std::uint32_t>(stamp_ns / 1000000000));
  put(out, static_cast<std::uint32_t>(stamp_ns % 1000000000));
}

void put_header(std::string& out, const Header& header) {
  put(out, header.sequence);
  put_time(out, header.stamp_ns);
  put_text(out, header.frame);
}

void put_pose(std::string& out, const Pose& pose) {
  const Vec3& t = pose.translation;
  const Quat& q = pose.rotation;
  for (const double value : {t.x, t.y, t.z, q.x, q.y, q.z, q.w}) put(out, value);
}

}  // namespace

const MessageType kClock{"rosgraph_msgs/Clock", "a9c97c1d230cfc112e270351a944ee47", "time clock\n"};

const MessageType kImage{"sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743",
                         "Header header\nuint32 height\nuint32 width\nstring encoding\n"
                         "uint8 is_bigendian\nuint32 step\nuint8[] data\n" RUBBLE_ROS_HEADER};

const MessageType kCameraInfo{
    "sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214",
    "Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] D\n"
    "float64[9] K\nfloat64[9] R\nfloat64[12] P\nuint32 binning_x\nuint32 binning_y\n"
    "RegionOfInterest roi\n" RUBBLE_ROS_HEADER RUBBLE_ROS_SECTION("sensor_msgs/RegionOfInterest")
        "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"};

const MessageType kPoseStamped{
    "geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5",
    "Header header\nPose pose\n" RUBBLE_ROS_HEADER RUBBLE_ROS_SECTION(
        "geometry_msgs/Pose") "Point position\nQuaternion orientation\n"
    RUBBLE_ROS_SECTION("geometry_msgs/Point") "float64 x\nfloat64 y\nfloat64 z\n"
        RUBBLE_ROS_QUATERNION};

const MessageType kTfMessage{
    "tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec",
    "geometry_msgs/TransformStamped[] transforms\n" RUBBLE_ROS_SECTION(
        "geometry_msgs/TransformStamped") "Header header\nstring child_frame_id\n"
    "Transform transform\n" RUBBLE_ROS_HEADER RUBBLE_ROS_SECTION(
        "geometry_msgs/Transform") "Vector3 translation\nQuaternion rotation\n"
    RUBBLE_ROS_SECTION("geometry_msgs/Vector3") "float64 x\nfloat64 y\nfloat64 z\n"
        RUBBLE_ROS_QUATERNION};

std::string clock(std::int64_t stamp_ns) {
  std::string out;
  put_time(out, stamp_ns);
  return out;
}

std::string image(const Header& header, const Intrinsics& intrinsics, const std::string& encoding,
                  int bytes_per_pixel, const void* data) {
  const auto height = static_cast<std::uint32_t>(intrinsics.height);
  const auto width = static_cast<std::uint32_t>(intrinsics.width);
  const auto step = width * static_cast<std::uint32_t>(bytes_per_pixel);
  std::string out;
  out.reserve(128 + std::size_t{step} * height);
  put_header(out, header);
  put(out, height);
  put(out, width);
  put_text(out, encoding);
  put(out, std::uint8_t{0});  // is_bigendian
  put(out, step);
  put_text(out, {static_cast<const char*>(data), std::size_t{step} * height});
  return out;
}

std::string camera_info(const Header& header, const Intrinsics& intrinsics) {
  const Intrinsics& k = intrinsics;
  std::string out;
  put_header(out, header);
  put(out, static_cast<std::uint32_t>(k.height));
  put(out, static_cast<std::uint32_t>(k.width));
  put_text(out, "plumb_bob");
  put(out, static_cast<std::uint32_t>(k.distortion.size()));
  for (const double d : k.distortion) put(out, d);
  for (const double v : {k.fx, 0.0, k.cx, 0.0, k.fy, k.cy, 0.0, 0.0, 1.0}) put(out, v);
  for (const double v : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) put(out, v);
  for (const double v : {k.fx, 0.0, k.cx, 0.0, 0.0, k.fy, k.cy, 0.0, 0.0, 0.0, 1.0, 0.0})
    put(out, v);
  for (int i = 0; i < 6; ++i) put(out, std::uint32_t{0});  // no binning, no region of interest
  put(out, std::uint8_t{0});                               // do_rectify
  return out;
}

std::string pose_stamped(const Header& header, const Pose& pose) {
  std::string out;
  put_header(out, header);
  put_pose(out, pose);
  return out;
}

std::string transform(const Header& header, const std::string& child, const Pose& pose) {
  std::string out;
  put(out, std::uint32_t{1});
  put_header(out, header);
  put_text(out, child);
  put_pose(out, pose);
  return out;
}

}  // namespace rubble::ros
