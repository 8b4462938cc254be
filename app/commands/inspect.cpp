// `rubble inspect`: the mission's world while it settles and after, to be stopped and pulled at (docs/how_to/inspect.md).
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/drive/drive_request.h"

namespace rubble {
namespace {

Action declare_inspect(CommandLine& line) {
  const auto request = std::make_shared<DriveRequest>();
  request->width = 640, request->height = 480;
  add_mission_options(line, request->of);
  add_seed_option(line, request->of);
  add_size_option(line, request->width, request->height);
  line.add("--steps", request->steps, "Number of pictures after which the inspection ends")
      .shows_default_text("none")
      .between(0, 1000000000);
  line.add("--out", request->of.out, "Output folder").shows_default_text("out/<script>_inspect").metavar("DIR");
  line.add_flag("--force", request->of.force, "Replace the files of an earlier inspection");
  add_device_option(line, request->of.options.device);
  add_threads_option(line, request->of.options.threads);
  add_quiet_option(line, request->of.options.quiet);
  return [request] { return inspect_mission(*request); };
}

}  // namespace

Command inspect_command() {
  return {"", "inspect", "Watch a mission settle and run in a window: pause, step, pull pieces, save moments", declare_inspect};
}

}  // namespace rubble
