// `rubble run`: the whole pipeline, from a script to recordings and a manifest.
#include <memory>
#include <string>
#include <vector>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/pipeline/run.h"

namespace rubble {
namespace {

Action declare_run(CommandLine& line) {
  const auto request = std::make_shared<RunRequest>();
  const auto also = std::make_shared<std::vector<std::string>>();
  add_mission_options(line, *request);
  line.add("--also", *also,
           "Another mission over the same pile, recorded afterwards. Each mission has the folder of its name in out/, or in --out")
      .metavar("FILE");
  add_seed_option(line, *request);
  add_track_option(line, *request);
  add_output_options(line, *request);
  add_run_options(line, request->options);
  add_checkpoint_option(line, request->options);
  add_preview_option(line, *request);
  add_live_options(line, request->options.live);
  return [request, also] { return also->empty() ? run_to_folder(*request, RunKind::run) : run_flights(*request, *also); };
}

}  // namespace

Command run_command() { return {"", "run", "Run a mission and write its dataset", declare_run}; }

}  // namespace rubble
