#include "io/ros/mcap_recorder.h"

namespace rubble {
namespace {

// rosbag2's profile of a publisher: keep last, reliable, and transient local (1) for what a late
// subscriber must still get, or volatile (2).
std::string qos(bool latched) {
  constexpr char kForever[] = ":\n    sec: 9223372036\n    nsec: 854775807\n";
  const auto duration = [&](const char* name) { return std::string("  ") + name + kForever; };
  return std::string("- history: 1\n  depth: ") + (latched ? "1" : "10") +
         "\n  reliability: 1\n  durability: " + (latched ? "1" : "2") + "\n" +
         duration("deadline") + duration("lifespan") + "  liveliness: 1\n" +
         duration("liveliness_lease_duration") + "  avoid_ros_namespace_conventions: false";
}

class McapFile : public RosFile {
 public:
  McapFile(const std::string& path, McapCompression compression, int threads)
      : mcap_(path, compression, threads) {}

  ros::Version version() const override { return ros::Version::ros2; }
  std::uint32_t add(const std::string& topic, const ros::MessageType& type, bool latched) override {
    return mcap_.add_channel(
        {topic, ros::type_name(type, version()), type.definition2, qos(latched)});
  }
  void write(std::uint32_t topic, std::int64_t stamp_ns, std::string_view message) override {
    mcap_.write(static_cast<std::uint16_t>(topic), stamp_ns, message);
  }
  void finish() override { mcap_.finish(); }

 private:
  McapWriter mcap_;
};

}  // namespace

std::unique_ptr<Recorder> make_mcap_recorder(const std::string& path, const RosOptions& options,
                                             McapCompression compression, int threads) {
  return make_ros_recorder(path, std::make_unique<McapFile>(path, compression, threads), options);
}

}  // namespace rubble
