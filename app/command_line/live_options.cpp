// The options of live publishing (docs/how_to/live.md).
#include <charconv>

#include "app/command_line/common_options.h"

namespace rubble {
namespace {

// `realtime`, `fast`, or a factor.
std::string read_rate(const std::string& text, double& rate) {
  if (text == "realtime") return rate = 1, "";
  if (text == "fast") return rate = 0, "";
  const char* const end = text.data() + text.size();
  double factor = 0;
  const auto read = std::from_chars(text.data(), end, factor);
  if (read.ec != std::errc() || read.ptr != end || !(factor >= 0.01 && factor <= 100))
    return "expected realtime, fast, or a factor from 0.01 to 100, found " + text;
  return rate = factor, "";
}

// ros2: the option that they need; null: none.
void add_domain_options(CommandLine& line, LiveRequest& live, const Option* ros2) {
  Option domain = line.add("--ros-domain", live.ros_domain, "The DDS domain")
                      .shows_default_text("$ROS_DOMAIN_ID, or 0")
                      .between(0, 232)
                      .metavar("N");
  Option interface = line.add("--ros-interface", live.ros_interface, "The network interface of DDS")
                         .shows_default_text("that of $CYCLONEDDS_URI, or lo")
                         .metavar("NAME");
  if (ros2) domain.needs(*ros2), interface.needs(*ros2);
}

Option add_rate_option(CommandLine& line, LiveRequest& live) {
  Option rate = line.add_read("--rate", [&live](const std::string& text) { return read_rate(text, live.rate); },
                              "Rate of publishing: realtime (default), fast, or a factor of real time");
  return rate.metavar("RATE");
}

struct RosOptions {
  Option ros1, ros2;
};

// one: not both of them.
RosOptions add_both(CommandLine& line, LiveRequest& live, const std::string& text, bool one) {
  const Option ros1 = line.add_flag("--ros1", live.ros1, text);
  line.add("--ros-master", live.ros_master, "The ROS master")
      .shows_default_text("$ROS_MASTER_URI")
      .metavar("URI")
      .needs(ros1);
  line.add("--ros-ip", live.ros_ip, "Address of this machine for subscribers on other machines")
      .shows_default_text("$ROS_IP, or only this machine")
      .metavar("ADDRESS")
      .needs(ros1);
  Option ros2 = line.add_flag("--ros2", live.ros2, "Publish the frames to ROS 2 over DDS during rendering");
  if (one) ros2.excludes(ros1);
  add_domain_options(line, live, &ros2);
  return {ros1, ros2};
}

}  // namespace

void add_ros_options(CommandLine& line, LiveRequest& live, const std::string& text) { add_both(line, live, text, true); }

void add_served_options(CommandLine& line, LiveRequest& live) {
  add_domain_options(line, live, nullptr);
  add_rate_option(line, live);
}

void add_live_options(CommandLine& line, LiveRequest& live) {
  const RosOptions ros = add_both(line, live, "Publish the frames to ROS 1 during rendering", false);
  add_rate_option(line, live).needs_one_of(ros.ros1, ros.ros2);
  line.add("--wait-for-subscribers", live.wait,
           "Longest time that the first frame waits until every topic has a subscriber")
      .shows_default()
      .metavar("SECONDS")
      .within(0.0, 1e6)
      .needs_one_of(ros.ros1, ros.ros2);
}

}  // namespace rubble
