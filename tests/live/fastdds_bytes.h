// Fast DDS for messages that are bytes already, with the names of ROS 2.
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <cstring>
#include <functional>
#include <memory>
#include <string>

namespace rubble::testing {

namespace fast = eprosima::fastdds::dds;

// A type of that name whose samples, std::strings, are CDR with its header of four bytes.
class Bytes : public fast::TopicDataType {
 public:
  explicit Bytes(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 32 << 20;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override {
    const std::string& bytes = *static_cast<std::string*>(data);
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = std::uint32_t(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<const char*>(payload->data),
                                            payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return std::uint32_t(static_cast<std::string*>(data)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

// as_installed: with all transports, on every interface; otherwise by UDP on the loopback interface
// alone.
inline fast::DomainParticipant* join(unsigned domain, bool as_installed) {
  fast::DomainParticipantQos qos;
  if (!as_installed) {
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.push_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
  }
  return fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
}

// The topic of that name in ROS 2, as DDS names it.
inline fast::Topic* make_topic(fast::DomainParticipant* participant, const std::string& topic,
                               const std::string& type) {
  const fast::TypeSupport support(new Bytes(type));
  support.register_type(participant);
  return participant->create_topic("rt" + topic, type, fast::TOPIC_QOS_DEFAULT);
}

inline void leave(fast::DomainParticipant* participant) {
  participant->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant);
}

}  // namespace rubble::testing
