// From a request to a finished folder: what `rubble run`, `settle` and `render` have in common.
#pragma once

#include <string>

#include "app/pipeline/run.h"

namespace rubble {

// --out, or out/<name of the script>.
std::string choose_output(const RunRequest& request);

// Runs the mission, as far as `kind` says, in a new folder. `did_not_settle` when pieces still moved.
ExitCode run_to_folder(const RunRequest& request, RunKind kind);

}  // namespace rubble
