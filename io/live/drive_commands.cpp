#include "io/live/drive_commands.h"

#include "io/live/wire_cursor.h"

namespace rubble {

TwistCommand read_twist(ros::Version version, std::string_view message) {
  WireCursor cursor("geometry_msgs/Twist", version, message);
  const Vec3 linear = cursor.vector();
  return {linear, cursor.vector()};
}

JoyCommand read_joy(ros::Version version, std::string_view message) {
  WireCursor cursor("sensor_msgs/Joy", version, message);
  cursor.header();
  JoyCommand joy;
  joy.axes = cursor.list<float>();
  joy.buttons = cursor.list<std::int32_t>();
  return joy;
}

JointTrajectoryCommand read_joint_trajectory(ros::Version version, std::string_view message) {
  WireCursor cursor("trajectory_msgs/JointTrajectory", version, message);
  cursor.header();
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

JointTrajectoryCommand read_joint_command(ros::Version version, std::string_view message) {
  WireCursor cursor("sensor_msgs/JointState with a position for every name", version, message);
  cursor.header();
  JointTrajectoryCommand command;
  for (std::size_t i = cursor.count(4); i > 0; --i) command.joints.push_back(cursor.text());
  JointTrajectoryCommand::Point point;
  point.positions = cursor.list<double>();
  if (command.joints.empty() || point.positions.size() != command.joints.size()) cursor.fail();
  command.points.push_back(std::move(point));
  return command;
}

}  // namespace rubble
