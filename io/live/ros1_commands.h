// Hears /cmd_vel, /joy and /joint_trajectory of ROS 1. Behind live_ros1.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "io/live/complaints.h"
#include "io/live/live_ros.h"
#include "io/live/master_watch.h"

namespace rubble {

class Ros1Commands {
 public:
  // notice: told of a message that cannot be used.
  Ros1Commands(::ros::NodeHandle& node, std::function<void(const std::string&)> notice);

  // What came until now. Everything happens in the thread that calls it.
  DriveCommands take();
  std::vector<KnownTopic> topics() const;

 private:
  template <typename Read>
  ::ros::Subscriber subscribe(::ros::NodeHandle& node, const char* topic, const char* type,
                              const char* md5, Read read);

  Complaints complaints_;
  ::ros::CallbackQueue queue_;
  DriveCommands heard_;
  std::vector<KnownTopic> topics_;
  ::ros::Subscriber twist_, joy_, trajectory_;  // last: they use the others
};

}  // namespace rubble
