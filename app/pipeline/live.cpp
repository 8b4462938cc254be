#include "app/pipeline/live.h"

#include <cstdlib>

#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/live/live_ros.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

void set_common(LiveOptions& live, const RunOptions& options) {
  live.rate = options.live.rate;
  live.wait = options.live.wait;
  live.stopped = stop_requested;
  if (options.quiet) return;
  live.notice = [](const std::string& line) {
    print_err("\nrubble: %s\n", line.c_str());
  };
}

Ros1Options ros1_options(const RunOptions& options) {
  Ros1Options ros1;
  set_common(ros1, options);
  ros1.master = options.live.ros_master;
  ros1.address = options.live.ros_ip;
  return ros1;
}

int domain_of_environment() {
  const char* text = std::getenv("ROS_DOMAIN_ID");
  if (!text || !*text) return 0;
  char* end = nullptr;
  const long domain = std::strtol(text, &end, 10);
  if (*end || domain < 0 || domain > 232)
    throw InputError({"", 0, "ROS_DOMAIN_ID", "not a DDS domain", "an integer from 0 to 232", text,
                      "set it, or say --ros-domain"});
  return int(domain);
}

Ros2Options ros2_options(const RunOptions& options) {
  Ros2Options ros2;
  set_common(ros2, options);
  ros2.domain = options.live.ros_domain ? *options.live.ros_domain : domain_of_environment();
  ros2.interface = options.live.ros_interface;
  return ros2;
}

class KeptStream : public RosFile {
 public:
  KeptStream(RosFile& stream, std::map<std::string, std::uint32_t>& topics) : stream_(stream), topics_(topics) {}

  ros::Version version() const override { return stream_.version(); }
  std::uint32_t add(const std::string& topic, const ros::MessageType& type, bool latched) override {
    const auto known = topics_.find(topic);
    if (known != topics_.end()) return known->second;
    return topics_[topic] = stream_.add(topic, type, latched);
  }
  void write(std::uint32_t topic, std::int64_t stamp_ns, std::string_view message) override {
    stream_.write(topic, stamp_ns, message);
  }
  void finish() override {}

 private:
  RosFile& stream_;
  std::map<std::string, std::uint32_t>& topics_;
};

}  // namespace

std::unique_ptr<RosFile> keep_stream(RosFile& stream, std::map<std::string, std::uint32_t>& topics) {
  return std::make_unique<KeptStream>(stream, topics);
}

std::unique_ptr<LiveServer> make_live_server(const RunOptions& options) { return make_ros2_server(ros2_options(options)); }

void check_live(const RunOptions& options) {
  if (options.live.ros2) check_ros2(ros2_options(options));
  if (options.live.ros1) check_ros1(ros1_options(options));
}

void add_live_recorders(RecorderSet& set, const RunOptions& options, const RosOptions& ros) {
  if (options.live.ros1)
    set.recorders.push_back(
        make_ros_recorder("--ros1", make_ros1_stream(ros1_options(options)), ros));
  if (options.live.ros2)
    set.recorders.push_back(
        make_ros_recorder("--ros2", make_ros2_stream(ros2_options(options)), ros));
}

std::unique_ptr<DriveStream> make_drive_stream(const RunOptions& options) {
  if (options.live.ros2) {
    Ros2Options ros2 = ros2_options(options);
    ros2.rate = 0;
    return make_ros2_drive(ros2);
  }
  if (!options.live.ros1) return nullptr;
  Ros1Options ros1 = ros1_options(options);
  ros1.rate = 0;
  return make_ros1_drive(ros1);
}

}  // namespace rubble
