#include "io/ros/rosbag_recorder.h"

namespace rubble {
namespace {

class Rosbag : public RosFile {
 public:
  Rosbag(const std::string& path, BagCompression compression) : bag_(path, compression) {}

  ros::Version version() const override { return ros::Version::ros1; }
  std::uint32_t add(const std::string& topic, const ros::MessageType& type, bool latched) override {
    return bag_.add_connection(
        {topic, ros::type_name(type, version()), type.md5, type.definition1, latched});
  }
  void write(std::uint32_t topic, std::int64_t stamp_ns, std::string_view message) override {
    bag_.write(topic, stamp_ns, message);
  }
  void finish() override { bag_.finish(); }

 private:
  BagWriter bag_;
};

}  // namespace

std::unique_ptr<Recorder> make_rosbag_recorder(const std::string& path, const RosOptions& options,
                                               BagCompression compression) {
  return make_ros_recorder(path, std::make_unique<Rosbag>(path, compression), options);
}

}  // namespace rubble
