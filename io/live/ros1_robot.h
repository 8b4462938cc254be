// A robot that is known by ROS 1 topics alone: what it says is heard, and it is driven by velocities. Of a build with
// roscpp only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/live/live_ros.h"
#include "io/live/robot_messages.h"

namespace rubble {

struct Ros1RobotOptions {
  Ros1Options ros;                       // `notice` is also told of messages that cannot be used
  std::string odometry = "/odom";        // nav_msgs/Odometry
  std::string cloud = "/points";         // sensor_msgs/PointCloud2; empty: none is heard
  std::string scan;                      // sensor_msgs/LaserScan; empty: none is heard
  std::string velocity = "/cmd_vel";     // geometry_msgs/Twist, published
};

// All that came since the last look, each in the order in which it came.
struct HeardRobot {
  std::vector<HeardOdometry> odometry;
  std::vector<HeardTransform> transforms;  // of /tf and /tf_static
  std::vector<HeardCloud> clouds;
};

class Ros1Robot {
 public:
  // After check_ros1() with the same options. Throws RunError where the master does not take the topics. As for other
  // streams, a master that goes is waited for, and told of the topics when it returns.
  explicit Ros1Robot(const Ros1RobotOptions& options);
  ~Ros1Robot();  // the robot gets a velocity of nothing

  // What came, waiting for something for so long at most; unit: s
  HeardRobot take(double seconds);
  // In the frame of the robot: forwards, and to the left; unit: m/s, rad/s
  void drive(double linear, double angular);
  bool is_driven() const;  // whether anybody hears the velocities

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble
