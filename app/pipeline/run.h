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

// Renders the mission in a new folder, with the pile of the finished run in the folder `from`.
ExitCode render_to_folder(const std::string& from, const RunRequest& request);

// Runs the mission, then renders the missions `also` over its pile, each in a folder of its script's name: in out/, or in
// --out. Throws InputError before anything runs if one of them states another pile.
ExitCode run_flights(const RunRequest& request, const std::vector<std::string>& also);

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
