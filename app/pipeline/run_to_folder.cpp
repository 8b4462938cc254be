#include "app/pipeline/run_to_folder.h"

#include <filesystem>

#include "app/pipeline/live.h"
#include "app/support/stop.h"

namespace rubble {

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

}  // namespace rubble
