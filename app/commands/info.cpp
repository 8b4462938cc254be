// `rubble info`: what this program and this machine are, or what lies at some paths.
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/commands/inspect_dataset.h"
#include "app/support/build_info.h"
#include "app/support/drawing_device.h"
#include "app/support/print.h"
#include "io/live/live_ros.h"
#include "io/ros/ros_idl.h"
#include "kernel/base/system/thread_count.h"

namespace rubble {
namespace {

struct InfoRequest {
  bool gl = false;                 // --gl: every way to draw, and the device's limits
  std::string device;              // --device; a card: its driver and limits
  std::vector<std::string> paths;  // recordings or folders of runs, instead of this machine
};

// Every way to draw on this machine, and what decides how it fares.
void print_ways() {
  const CardReport report = report_cards();
  print_out("ways to draw, in the order in which they are tried\n");
  for (const auto& [name, outcome] : report.ways) print_out("  %s: %s\n", name.c_str(), outcome.c_str());
  const char* environment = std::getenv("RUBBLE_DEVICE");
  print_out("RUBBLE_DEVICE: %s\n", environment && *environment ? environment : "not set");
  for (const std::string& line : report.circumstances) print_out("note: %s\n", line.c_str());
  std::fflush(stdout);
}

void print_card(int number) {
  print_ways();
  const std::unique_ptr<Device> card = make_device({DeviceKind::gl, number, 0});
  for (const auto& [name, value] : card->info().details)
    print_out("%-14s%s\n", (name == "egl_device" ? "chosen" : name).c_str(), value.c_str());
  for (const auto& [name, value] : card->info().limits) print_out("  %-24s%d\n", name.c_str(), value);
}

ExitCode print_info(const InfoRequest& request) {
  const AskedDevice card_asked = asked_device(request.device).value_or(AskedDevice{});
  const BuildInfo build = build_info();
  print_out("rubble        %s (%s)\n", build.version.c_str(), build.commit.c_str());
  print_out("built with    %s, %s, for %s\n", build.compiler.c_str(), build.flags.c_str(),
            build.target.c_str());
  print_out("threads       %d\n", default_thread_count());
  for (const auto& [name, version] : build.libraries)
    print_out("%-13s %s\n", name.c_str(), version.c_str());
  print_out("Simbody bits  %s\n",
            build.simbody_bits == "reference"
                ? "reference: piles with joints are the same on every machine that says so"
                : "other: piles with joints differ in last bits from those of x86-64; see "
                  "docs/explanation/determinism.md");
  print_out("live ROS 1    %s\n", describe_ros1().c_str());
  print_out("live ROS 2    %s\n", describe_ros2().c_str());
  print_out("device        software: %s\n", make_device({})->info().about.c_str());
  const std::string card = find_card();
  print_out("device        gl: %s\n", card.empty() ? "no graphics card is seen" : card.c_str());
  std::fflush(stdout);  // the versions are worth having even if EGL fails below
  if (request.gl || (!request.device.empty() && card_asked.kind == DeviceKind::gl)) print_card(card_asked.card);
  return ExitCode::done;
}

Action declare_info(CommandLine& line) {
  const auto request = std::make_shared<InfoRequest>();
  line.add_flag("--gl", request->gl,
                "List every EGL device with its driver or error, and mark the chosen one");
  add_device_option(line, request->device);
  line.add_print("--idl", ros::make_idl, "Print the messages of ROS 2 in IDL, for programs that read DDS without ROS 2");
  line.add("path", request->paths,
           "Recordings, or folders of runs: list their contents and check their integrity")
      .metavar("PATH");
  return [request] {
    return request->paths.empty() ? print_info(*request) : inspect_datasets(request->paths);
  };
}

}  // namespace

Command info_command() {
  return {"", "info", "Print versions, devices that draw, and threads; or list and check datasets",
          declare_info};
}

}  // namespace rubble
