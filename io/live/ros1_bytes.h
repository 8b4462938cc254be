// Messages of ROS 1 that are bytes already, for roscpp: what is sent was written by io/ros, and what is heard is read
// by our own readers. Behind live_ros1, ros1_commands and ros1_robot.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <cstring>
#include <functional>
#include <string>
#include <string_view>

namespace rubble {

// Its type is told to roscpp when its topic is advertised.
struct SerializedBytes {
  std::string_view bytes;
};

// A message as it came, of whatever type.
struct HeardBytes {
  std::string bytes;
};

}  // namespace rubble

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<rubble::SerializedBytes> {
  static const char* value() { return "*"; }  // agrees with every topic
  static const char* value(const rubble::SerializedBytes&) { return "*"; }
};
template <>
struct DataType<rubble::SerializedBytes> {
  static const char* value() { return "*"; }
  static const char* value(const rubble::SerializedBytes&) { return "*"; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<rubble::SerializedBytes> {
  template <typename Stream>
  static void write(Stream& stream, const rubble::SerializedBytes& message) {
    std::memcpy(stream.advance(std::uint32_t(message.bytes.size())), message.bytes.data(),
                message.bytes.size());
  }
  static std::uint32_t serializedLength(const rubble::SerializedBytes& message) {
    return std::uint32_t(message.bytes.size());
  }
};

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

struct HeardTopic {
  std::string topic, type, md5;  // roscpp refuses publishers of another type
};

// hear: called by what calls `queue`, which must outlive the subscriber. size: messages that wait; older ones go.
inline ::ros::Subscriber subscribe_to_bytes(::ros::NodeHandle& node, ::ros::CallbackQueue& queue, const HeardTopic& heard,
                                            std::uint32_t size, const std::function<void(const std::string&)>& hear) {
  using Message = boost::shared_ptr<const HeardBytes>;
  ::ros::SubscribeOptions options;
  options.topic = heard.topic;
  options.queue_size = size;
  options.md5sum = heard.md5;
  options.datatype = heard.type;
  options.callback_queue = &queue;
  options.transport_hints = ::ros::TransportHints().tcpNoDelay();
  options.helper = boost::make_shared<::ros::SubscriptionCallbackHelperT<const Message&>>(
      boost::function<void(const Message&)>([hear](const Message& message) { hear(message->bytes); }));
  return node.subscribe(options);
}

}  // namespace rubble
