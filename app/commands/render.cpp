// `rubble render`: a mission's camera, light and recordings over the pile of a finished run.
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/pipeline/run.h"

namespace rubble {
namespace {

Action declare_render(CommandLine& line) {
  const auto request = std::make_shared<RunRequest>();
  const auto from = std::make_shared<std::string>();
  line.add("folder", *from, "The output folder of the run with the pile").required().metavar("DIR");
  add_mission_options(line, *request, "--mission");
  add_seed_option(line, *request);
  add_output_options(line, *request);
  add_run_options(line, request->options);
  add_live_options(line, request->options.live);
  return [request, from] { return render_to_folder(*from, *request); };
}

}  // namespace

Command render_command() {
  return {"", "render", "Render the path of another mission with the pile of a finished run",
          declare_render};
}

}  // namespace rubble
