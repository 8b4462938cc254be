#include "io/live/ros1_commands.h"

#include <exception>

namespace rubble {
namespace {

// A message as it came, of whatever type.
struct HeardBytes {
  std::string bytes;
};

// Older ones go when a program sends faster than steps are driven.
constexpr std::uint32_t kQueue = 100;

}  // namespace
}  // namespace rubble

namespace ros {
namespace serialization {

template <>
struct Serializer<rubble::HeardBytes> {
  template <typename Stream>
  static void read(Stream& stream, rubble::HeardBytes& message) {
    const std::uint32_t size = stream.getLength();
    message.bytes.assign(reinterpret_cast<const char*>(stream.advance(size)), size);
  }
};

}  // namespace serialization
}  // namespace ros

namespace rubble {

template <typename Read>
::ros::Subscriber Ros1Commands::subscribe(::ros::NodeHandle& node, const char* topic,
                                          const char* type, const char* md5, Read read) {
  using Message = boost::shared_ptr<const HeardBytes>;
  // One that is no such message is said and left out: others go on driving.
  const auto hear = [this, topic, read](const Message& message) {
    try {
      read(message->bytes);
    } catch (const std::exception& error) {
      complaints_.note(topic, error.what());
    }
  };
  ::ros::SubscribeOptions options;
  options.topic = topic;
  options.queue_size = kQueue;
  options.md5sum = md5;  // roscpp refuses publishers of another type
  options.datatype = type;
  options.callback_queue = &queue_;
  options.transport_hints = ::ros::TransportHints().tcpNoDelay();
  options.helper =
      boost::make_shared<::ros::SubscriptionCallbackHelperT<const Message&>>(
          boost::function<void(const Message&)>(hear));
  const ::ros::Subscriber subscriber = node.subscribe(options);
  topics_.push_back({topic, type, KnownTopic::heard});
  return subscriber;
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
