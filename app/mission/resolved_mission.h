// What a run computes, resolved before it begins and never changed by it: where it comes from,
// every key, every asset.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/provenance/provenance.h"
#include "app/provenance/run_folder.h"
#include "app/support/run_request.h"
#include "kernel/base/error.h"
#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct ResolvedMission {
  Provenance provenance;   // from which all the rest can be made again
  Scenario scenario;       // of a `render`, what settled the pile is that of the other run
  AssetLibrary assets;     // of the pile
};

// What a command was asked besides the script. Throws InputError where it says one thing twice.
MissionOptions mission_options(const RunRequest& request);

// From a script on the disk. Prints what the script prints, and warnings of the assets.
ResolvedMission resolve_mission(const RunRequest& request, RunKind kind, RunContext& context);
// The pile of a provenance; the packs are looked for in `pack_folders` and among the bundled ones.
ResolvedMission resolve_pile(const Provenance& provenance, const std::vector<std::string>& pack_folders,
                             RunContext& context);
// The same with the URDF files of its robots: for a run that is made again. Throws InputError where one is not the same.
ResolvedMission resolve_mission(const Provenance& provenance,
                                const std::vector<std::string>& pack_folders, RunContext& context);
// A new camera and light over the pile of a finished run, in `saved`; its packs as above.
struct FinishedRun;
ResolvedMission resolve_render(const RunRequest& request, const FinishedRun& saved,
                               RunContext& context);
// What the unfinished run in that folder was computing. Throws InputError when another program
// began it.
ResolvedMission resolve_unfinished(const RunFolder& folder,
                                   const std::vector<std::string>& pack_folders,
                                   RunContext& context);

// unfinished/run.json: what was being run, and by which program.
std::string describe_unfinished(const ResolvedMission& mission);

// What is dropped and what it is dropped on, before it settles.
Pile make_pile(const ResolvedMission& mission);
// The same with the victims that were put into it since, for World::lay().
Pile make_laid_pile(const ResolvedMission& mission, const PileState& state);

// Throws what work() throws; of an InputError, mistakes that show only when there is a pile, with the lines of
// their keys in the script.
InputError with_lines(const ResolvedMission& mission, const InputError& error);
template <typename Work>
auto with_lines_of_script(const ResolvedMission& mission, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw with_lines(mission, error);
  }
}

}  // namespace rubble
