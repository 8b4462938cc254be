// Flights of further missions over a pile that a run has settled.
#include <algorithm>
#include <filesystem>
#include <set>

#include "app/mission/finished_run.h"
#include "app/mission/resolved_mission.h"
#include "app/pipeline/live.h"
#include "app/pipeline/run.h"
#include "app/provenance/compare.h"
#include "app/support/stop.h"
#include "app/surroundings/pile_surroundings.h"
#include "io/state/track_file.h"

namespace rubble {
namespace {

// Of the run that settled the pile. Throws InputError when it kept none.
Track load_track_of(const std::string& from) {
  const std::string path = from + "/track.bin";
  std::error_code failed;
  if (!std::filesystem::exists(path, failed))
    throw InputError(
        {from, 0, "", "the run has no track of the settling pile", "a track.bin",
         "none",
         "run its mission again with --track, or without record_settling and outputs.track"});
  return load_track(path);
}

Scenario load_scenario(const RunRequest& request) {
  return load_mission(request.mission, mission_options(request)).scenario;
}

// Before the pile is settled. Throws InputError: another pile, seed, or a track that the first run does not keep.
void check_same_pile(const RunRequest& first, const Scenario& scenario, const RunRequest& other) {
  const auto refuse = [&](const Difference& d, const std::string& message, const std::string& hint) {
    throw InputError({other.mission, 0, d.path, message + first.mission, d.was, d.is, hint});
  };
  const Scenario own = load_scenario(other);
  Scenario adopted = own;
  adopt_pile(adopted, scenario);
  if (own.seed != scenario.seed)
    refuse({"seed", std::to_string(scenario.seed), std::to_string(own.seed)}, "has another seed than ",
           "--seed holds for all missions");
  const std::vector<Difference> differences = list_differences(adopted, own);
  if (!differences.empty())
    refuse(differences[0], "states another pile than ",
           "put what they share (packs, pile, victims, fines, settle) into one file, and take it by rubble.include");
  if (needs_track(own) && !needs_track(scenario) && !first.track)
    refuse({"record_settling", "", ""}, "needs the track of the settling pile of ", "say --track");
}

}  // namespace

ExitCode render_to_folder(const std::string& from, const RunRequest& request) {
  stop_on_signals();
  check_live(request.options);
  const FinishedRun saved = open_finished_run(from);
  PileState pile = load_pile_of(saved);
  RunContext context(request.options);
  const ResolvedMission mission = resolve_render(request, saved, context);
  lay_surroundings(mission.scenario, mission.assets, pile);
  std::error_code failed;
  if (std::filesystem::equivalent(from, choose_output(request), failed))
    throw InputError({from, 0, "--out", "would replace the run that the pile comes from", "", "",
                      "choose another folder"});
  const bool moves = needs_track(mission.scenario);
  const Track track = moves ? load_track_of(from) : Track();
  RunFolder folder = RunFolder::create(choose_output(request), request.force);
  folder.begin(describe_unfinished(mission));
  if (moves) save_track(track, folder.file("track.bin"));
  keep_pile(mission, pile, folder);
  return complete(mission, folder, context);
}

ExitCode run_flights(const RunRequest& request, const std::vector<std::string>& also) {
  std::vector<RunRequest> runs(1 + also.size(), request);
  std::set<std::string> names;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i > 0) runs[i].mission = also[i - 1], runs[i].track = false;
    const std::string name = std::filesystem::path(runs[i].mission).stem().string();
    if (!names.insert(name).second)
      throw InputError({runs[i].mission, 0, "--also", "has the name of another mission", "missions of different names", name,
                        "each writes into the folder of its name"});
    if (!request.out.empty()) runs[i].out = request.out + "/" + name;
  }
  const Scenario scenario = load_scenario(request);
  for (std::size_t i = 1; i < runs.size(); ++i) check_same_pile(request, scenario, runs[i]);
  ExitCode code = run_to_folder(runs[0], RunKind::run);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const ExitCode next = request.preview ? run_to_folder(runs[i], RunKind::run) : render_to_folder(choose_output(runs[0]), runs[i]);
    code = std::max(code, next);
  }
  return code;
}

}  // namespace rubble
