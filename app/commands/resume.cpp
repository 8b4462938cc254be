// `rubble resume`: goes on with a run that was stopped or killed.
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/pipeline/run.h"
#include "app/support/stop.h"

namespace rubble {
namespace {

ExitCode resume_run(const FolderRequest& request) {
  stop_on_signals();
  RunFolder folder = RunFolder::open_unfinished(request.folder);
  RunContext context(request.options);
  const ResolvedMission mission = resolve_unfinished(folder, request.asset_packs, context);
  return complete(mission, folder, context);
}

Action declare_resume(CommandLine& line) {
  const auto request = std::make_shared<FolderRequest>();
  add_folder_options(line, *request);
  add_run_options(line, request->options);
  add_checkpoint_option(line, request->options);
  return [request] { return resume_run(*request); };
}

}  // namespace

Command resume_command() {
  return {"", "resume", "Continue a run that was stopped or killed", declare_resume};
}

}  // namespace rubble
