#include "io/live/ros1_commands.h"

#include <exception>

#include "io/live/ros1_bytes.h"

namespace rubble {
namespace {

// Older ones go when a program sends faster than steps are driven.
constexpr std::uint32_t kCommands = 100;

}  // namespace

template <typename Read>
::ros::Subscriber Ros1Commands::subscribe(::ros::NodeHandle& node, const char* topic,
                                          const char* type, const char* md5, Read read) {
  // One that is no such message is said and left out: others go on driving.
  const auto hear = [this, topic, read](const std::string& bytes) {
    try {
      read(bytes);
    } catch (const std::exception& error) {
      complaints_.note(topic, error.what());
    }
  };
  topics_.push_back({topic, type, KnownTopic::heard});
  return subscribe_to_bytes(node, queue_, {topic, type, md5}, kCommands, hear);
}

Ros1Commands::Ros1Commands(::ros::NodeHandle& node, std::function<void(const std::string&)> notice)
    : complaints_(std::move(notice)) {
  constexpr auto kRos1 = ros::Version::ros1;
  twist_ = subscribe(node, "/cmd_vel", "geometry_msgs/Twist", "9f195f881246fdfa2798d1d3eebca84a",
                     [this](const std::string& bytes) {
                       heard_.twists.push_back(read_twist(kRos1, bytes));
                     });
  joy_ = subscribe(node, "/joy", "sensor_msgs/Joy", "5a9ea5f83505693b71e785041e67a8bb",
                   [this](const std::string& bytes) {
                     heard_.joys.push_back(read_joy(kRos1, bytes));
                   });
  trajectory_ = subscribe(node, "/joint_trajectory", "trajectory_msgs/JointTrajectory",
                          "65b4f94a94d1ed67169da35a02f33d3f", [this](const std::string& bytes) {
                            heard_.trajectories.push_back(read_joint_trajectory(kRos1, bytes));
                          });
}

DriveCommands Ros1Commands::take() {
  queue_.callAvailable();
  DriveCommands commands = std::move(heard_);
  heard_ = {};
  commands.joy_connected = joy_.getNumPublishers() > 0;
  return commands;
}

std::vector<KnownTopic> Ros1Commands::topics() const { return topics_; }

}  // namespace rubble
