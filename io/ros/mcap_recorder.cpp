#include "io/ros/mcap_recorder.h"

#include <numeric>

#include "io/base/atomic_file.h"
#include "kernel/base/system/output_files.h"

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

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '\n' ? "\\n" : std::string(c == '"' || c == '\\' ? "\\" : "") + c;
  return out + "\"";
}

// Version 5 of the format: the last one that ROS 2 Humble reads; later releases and rosbags read it as well. The chunks
// are compressed within the MCAP file, so there is no compression of rosbag2.
std::string metadata_yaml(const std::string& file, const McapSummary& bag) {
  const std::uint64_t messages = std::accumulate(bag.counts.begin(), bag.counts.end(), std::uint64_t{0});
  const auto times = [&](const std::string& indent) {
    return indent + "duration:\n" + indent + "  nanoseconds: " + std::to_string(bag.last_ns - bag.first_ns) + "\n" +
           indent + "starting_time:\n" + indent + "  nanoseconds_since_epoch: " + std::to_string(bag.first_ns) + "\n" +
           indent + "message_count: " + std::to_string(messages) + "\n";
  };
  std::string yaml = "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n" + times("  ") +
                     "  topics_with_message_count:\n";
  for (std::size_t i = 0; i < bag.topics.size(); ++i) {
    const McapTopic& topic = bag.topics[i];
    yaml += "    - topic_metadata:\n        name: " + topic.topic + "\n        type: " + topic.type +
            "\n        serialization_format: cdr\n        offered_qos_profiles: " + quoted(topic.qos) +
            "\n      message_count: " + std::to_string(bag.counts[i]) + "\n";
  }
  return yaml + "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " + quoted(file) +
         "\n  files:\n    - path: " + quoted(file) + "\n" + times("      ");
}

class McapFile : public RosFile {
 public:
  McapFile(const std::string& path, McapCompression compression, int threads)
      : mcap_(path, compression, threads), name_(path.substr(path.rfind('/') + 1)),
        metadata_path_(path.substr(0, path.size() - name_.size()) + kBagMetadata) {}

  ros::Version version() const override { return ros::Version::ros2; }
  std::uint32_t add(const std::string& topic, const ros::MessageType& type, bool latched) override {
    return mcap_.add_channel(
        {topic, ros::type_name(type, version()), type.definition2, qos(latched)});
  }
  void write(std::uint32_t topic, std::int64_t stamp_ns, std::string_view message) override {
    mcap_.write(static_cast<std::uint16_t>(topic), stamp_ns, message);
  }
  void finish() override {
    write_text_file(metadata_path_, metadata_yaml(name_, mcap_.summary()));
    try {
      mcap_.finish();
    } catch (...) {
      remove_output_file(metadata_path_);
      throw;
    }
  }

 private:
  McapWriter mcap_;
  std::string name_, metadata_path_;  // of the file, and beside it
};

}  // namespace

std::unique_ptr<Recorder> make_mcap_recorder(const std::string& path, const RosOptions& options,
                                             McapCompression compression, int threads) {
  return make_ros_recorder(path, std::make_unique<McapFile>(path, compression, threads), options);
}

}  // namespace rubble
