// `rubble check`: resolves everything and runs nothing.
#include <cstdio>

#include "app/assets/asset_library.h"
#include "app/commands/commands.h"
#include "kernel/base/text.h"
#include "scripting/mission.h"

namespace rubble {

ExitCode check_mission(const RunRequest& request) {
  MissionOptions options;
  options.seed = request.seed;
  options.overrides = request.overrides;
  const Mission mission = load_mission(request.mission, options);
  for (const std::string& line : mission.printed) std::fprintf(stderr, "%s\n", line.c_str());
  const AssetLibrary assets = load_assets(mission, request.asset_packs);
  for (const std::string& warning : assets.warnings)
    std::fprintf(stderr, "warning: %s\n", printable(warning).c_str());
  std::printf("%s\n", scenario_to_json(mission.scenario).c_str());
  return ExitCode::done;
}

}  // namespace rubble
