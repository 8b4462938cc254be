// A run from a request to a finished folder, stage by stage: app/pipeline/stages.h.
#pragma once

#include <functional>
#include <string>

#include "app/pipeline/stages.h"
#include "kernel/base/error.h"

namespace rubble {

// --out, or out/<name of the script>.
std::string choose_output(const RunRequest& request);

// Runs the mission, as far as `kind` says, in a new folder. `did_not_settle` when pieces still
// moved.
ExitCode run_to_folder(const RunRequest& request, RunKind kind);

// What the stages of a run gave.
struct StageResults {
  PileState pile;         // settled, or as the time limit left it
  Metrics metrics;        // of all stages
  RecordedFrames frames;  // none where there are none to record
};

// Told of the pile before anything else is made of it; false: the rest is left out.
using PileCheck = std::function<bool(const SettledPile&)>;

// Settles the mission's pile and, where it has them, records its frames. with_frames: false leaves robots,
// flight and frames out.
StageResults run_stages(const ResolvedMission& mission, RunFolder& folder, RunContext& context,
                        bool with_frames, const PileCheck& check = {});

// Marks the folder as unfinished, runs every stage that is not finished yet, and unmarks it. Prints
// the folder. Throws as the stages do, after saying how to continue.
ExitCode complete(const ResolvedMission& mission, RunFolder& folder, RunContext& context);

}  // namespace rubble
