// The options of live publishing (docs/live.md).
#include "app/commands/arguments.h"

namespace rubble {
namespace {

// `realtime`, `fast`, or a factor.
double read_rate(const std::string& text) {
  if (text == "realtime") return 1;
  if (text == "fast") return 0;
  double rate = 0;
  if (!CLI::detail::lexical_cast(text, rate) || !(rate >= 0.01 && rate <= 100))
    throw CLI::ValidationError("--rate", "expected realtime, fast, or a factor from 0.01 to 100, found " + text);
  return rate;
}

}  // namespace

void add_ros_options(CLI::App& command, LiveRequest& live, const std::string& text) {
  CLI::Option* const ros1 = command.add_flag("--ros1", live.ros1, text);
  command.add_option("--ros-master", live.ros_master, "The ROS master (default: $ROS_MASTER_URI)")
      ->type_name("URI")
      ->needs(ros1);
  command
      .add_option("--ros-ip", live.ros_ip,
                  "Let programs of other machines connect, to this address (default: $ROS_IP, or "
                  "only this machine)")
      ->type_name("ADDRESS")
      ->needs(ros1);
  CLI::Option* const ros2 =
      command.add_flag("--ros2", live.ros2, "The same to ROS 2, over DDS");
  command.add_option("--ros-domain", live.ros_domain, "The DDS domain (default: $ROS_DOMAIN_ID, or 0)")
      ->check(CLI::Range(0, 232))
      ->type_name("N")
      ->needs(ros2);
  command
      .add_option("--ros-interface", live.ros_interface,
                  "The network interface of DDS (default: as $CYCLONEDDS_URI says, or lo)")
      ->type_name("NAME")
      ->needs(ros2);
}

void add_live_options(CLI::App& command, LiveRequest& live) {
  add_ros_options(command, live, "Publish the frames to ROS 1 while they are drawn");
  command
      .add_option_function<std::string>(
          "--rate", [&live](const std::string& text) { live.rate = read_rate(text); },
          "How fast to publish: realtime (default), fast, or a factor")
      ->type_name("RATE");
  command
      .add_option("--wait-for-subscribers", live.wait,
                  "Hold the first frame until every topic has one, at most that long (default: 0)")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1e6));
}

}  // namespace rubble
