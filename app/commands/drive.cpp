// `rubble drive`: the mission's pile, flown through by hand in a window (docs/how_to/drive.md).
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/drive/drive_request.h"

namespace rubble {
namespace {

Action declare_drive(CommandLine& line) {
  const auto request = std::make_shared<DriveRequest>();
  add_mission_options(line, request->of);
  add_seed_option(line, request->of);
  add_size_option(line, request->width, request->height);
  line.add("--steps", request->steps, "Number of steps after which the drive ends")
      .shows_default_text("none")
      .between(0, 1000000000);
  line.add("--robot", request->robot, "Name of the robot to drive")
      .shows_default_text("the first")
      .metavar("NAME");
  line.add_flag("--record", request->record, "Write the recordings of the mission during the drive");
  add_ros_options(line, request->of.options.live,
                  "Publish the frames to ROS 1, and take commands from /cmd_vel and /joy");
  line.add("--out", request->of.out, "Output folder")
      .shows_default_text("out/<script>_drive")
      .metavar("DIR");
  line.add_flag("--force", request->of.force, "Replace the files of an earlier drive");
  add_device_option(line, request->of.options.device);
  add_threads_option(line, request->of.options.threads);
  add_quiet_option(line, request->of.options.quiet);
  return [request] { return drive_mission(*request); };
}

}  // namespace

Command drive_command() {
  return {"", "drive", "Fly the camera or drive a robot in a window, and save the drive as a mission",
          declare_drive};
}

}  // namespace rubble
