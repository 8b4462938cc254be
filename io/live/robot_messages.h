// What a robot says of itself in ROS's messages: where it is, where its frames are, and what its range sensors saw.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/ros/ros_wire.h"
#include "kernel/base/math.h"

namespace rubble {

struct HeardOdometry {
  std::int64_t stamp_ns = 0;
  std::string frame, child;
  Pose frame_from_child;
};

struct HeardTransform {
  std::int64_t stamp_ns = 0;
  std::string parent, child;  // without the slash that old programs begin them with
  Pose parent_from_child;
};

struct HeardPoint {
  Vec3f place;     // in the frame of the sensor; finite; unit: m
  float time = 0;  // since the stamp; 0 where the cloud does not say; unit: s
};

// Of a scanner in three dimensions or in two.
struct HeardCloud {
  std::int64_t stamp_ns = 0;
  std::string frame;
  std::vector<HeardPoint> points;
  std::size_t left_out = 0;  // points with a coordinate that is not finite; of a scan, ranges that are NaN
};

// All throw RunError when the bytes are no such message; the first two also where a number of a pose is not finite.
HeardOdometry read_odometry(ros::Version version, std::string_view message);                  // nav_msgs/Odometry
std::vector<HeardTransform> read_transforms(ros::Version version, std::string_view message);  // tf2_msgs/TFMessage
// sensor_msgs/PointCloud2 with fields x, y and z of float32 or float64, wherever they lie, little-endian. Of a field
// `time` or `t` (float32 or float64: s; uint32: ns) it takes the times of the points.
HeardCloud read_point_cloud(ros::Version version, std::string_view message);
// sensor_msgs/LaserScan: its echoes between range_min and range_max, in the plane z = 0.
HeardCloud read_laser_scan(ros::Version version, std::string_view message);

}  // namespace rubble
