// `rubble run`, `settle`, `render` and `resume`: four ways to begin, one to complete.
#include <filesystem>

#include "app/commands/commands.h"
#include "app/pipeline/finished_run.h"
#include "app/pipeline/live.h"
#include "app/pipeline/run.h"
#include "app/support/stop.h"

namespace rubble {
namespace {

std::string choose_output(const RunRequest& request) {
  if (!request.out.empty()) return request.out;
  return "out/" + std::filesystem::path(request.mission).stem().string();
}

ExitCode run_to_folder(const RunRequest& request, RunKind kind) {
  stop_on_signals();
  check_live(request.options);
  Run run = start_run(request, kind);
  RunFolder folder = RunFolder::create(choose_output(request), request.force);
  return complete(run, folder);
}

}  // namespace

ExitCode run_mission(const RunRequest& request) { return run_to_folder(request, RunKind::run); }

ExitCode settle_mission(const RunRequest& request) {
  return run_to_folder(request, RunKind::settle);
}

ExitCode render_saved_pile(const std::string& from, const RunRequest& request) {
  stop_on_signals();
  check_live(request.options);
  const SavedRun saved = open_saved_run(from);
  const PileState pile = load_pile_of(saved);
  Run run = start_render(request, saved);
  std::error_code failed;
  if (std::filesystem::equivalent(from, choose_output(request), failed))
    throw InputError({from, 0, "--out", "would replace the run that the pile comes from", "", "",
                      "choose another folder"});
  RunFolder folder = RunFolder::create(choose_output(request), request.force);
  folder.begin(describe_unfinished(run));
  keep_pile(run, pile, folder);
  return complete(run, folder);
}

ExitCode resume_run(const FolderRequest& request) {
  stop_on_signals();
  RunFolder folder = RunFolder::open_unfinished(request.folder);
  Run run = continue_run(request.options, folder, request.asset_packs);
  return complete(run, folder);
}

}  // namespace rubble
