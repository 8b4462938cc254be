// Executes a run from a request to a finished folder. The stages are in app/pipeline/stages.h.
#pragma once

#include <functional>
#include <string>

#include "app/pipeline/stages.h"
#include "kernel/base/error.h"

namespace rubble {

// --out, or out/<name of the script>.
std::string choose_output(const RunRequest& request);

// Runs the mission in a new folder, up to the stage that `kind` selects. Returns `did_not_settle` if pieces still
// moved.
ExitCode run_to_folder(const RunRequest& request, RunKind kind);

// Results of the stages of a run.
struct StageResults {
  PileState pile;         // settled, or the state at the time limit
  Metrics metrics;        // of all stages
  RecordedFrames frames;  // empty without frames
};

// Called with the pile after settling. If it returns false, all later stages are skipped.
using PileCheck = std::function<bool(const SettledPile&)>;

// Settles the mission's pile and records its frames. with_frames: false skips robots, flight and frames.
StageResults run_stages(const ResolvedMission& mission, RunFolder& folder, RunContext& context,
                        bool with_frames, const PileCheck& check = {});

// Marks the folder as unfinished, runs every unfinished stage, and removes the mark. Prints the folder. Exceptions of
// stages are passed on with a hint how to continue.
ExitCode complete(const ResolvedMission& mission, RunFolder& folder, RunContext& context);

}  // namespace rubble
