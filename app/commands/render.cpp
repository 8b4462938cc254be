// `rubble render`: a mission's camera, light and recordings over the pile of a finished run.
#include <filesystem>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/mission/finished_run.h"
#include "app/pipeline/live.h"
#include "app/pipeline/run.h"
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

ExitCode render_finished_pile(const std::string& from, const RunRequest& request) {
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

Action declare_render(CommandLine& line) {
  const auto request = std::make_shared<RunRequest>();
  const auto from = std::make_shared<std::string>();
  line.add("folder", *from, "The output folder of the run with the pile").required().metavar("DIR");
  add_mission_options(line, *request, "--mission");
  add_seed_option(line, *request);
  add_output_options(line, *request);
  add_run_options(line, request->options);
  add_live_options(line, request->options.live);
  return [request, from] { return render_finished_pile(*from, *request); };
}

}  // namespace

Command render_command() {
  return {"", "render", "Render the path of another mission with the pile of a finished run",
          declare_render};
}

}  // namespace rubble
