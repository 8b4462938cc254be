// `rubble settle`: the pile only: pile.bin, pile.stl, manifest.json, and its track where it is
// asked for.
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/pipeline/run.h"

namespace rubble {
namespace {

Action declare_settle(CommandLine& line) {
  const auto request = std::make_shared<RunRequest>();
  add_mission_options(line, *request);
  add_seed_option(line, *request);
  add_track_option(line, *request);
  add_output_options(line, *request);
  add_threads_option(line, request->options.threads);
  add_quiet_option(line, request->options.quiet);
  add_checkpoint_option(line, request->options);
  add_preview_option(line, *request);
  return [request] { return run_to_folder(*request, RunKind::settle); };
}

}  // namespace

Command settle_command() {
  return {"", "settle", "Settle the pile of a mission, without rendering", declare_settle};
}

}  // namespace rubble
