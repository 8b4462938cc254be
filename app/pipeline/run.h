// A run from a request to a finished folder: resolve -> settle -> files -> frames -> manifest
// (app/pipeline/stages.h).
#pragma once

#include <string>

#include "app/pipeline/stages.h"
#include "kernel/base/error.h"

namespace rubble {

// --out, or out/<name of the script>.
std::string choose_output(const RunRequest& request);

// Runs the mission, as far as `kind` says, in a new folder. `did_not_settle` when pieces still
// moved.
ExitCode run_to_folder(const RunRequest& request, RunKind kind);

// Marks the folder as unfinished, runs every stage that is not finished yet, and unmarks it. Prints
// the folder. Throws as the stages do, after saying how to continue.
ExitCode complete(const ResolvedMission& mission, RunFolder& folder, RunContext& context);

}  // namespace rubble
