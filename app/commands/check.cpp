// `rubble check`: resolves everything and runs nothing.
#include <memory>

#include "app/assets/asset_library.h"
#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/support/print.h"
#include "scripting/mission.h"
#include "scripting/reference/schema_docs.h"

namespace rubble {
namespace {

ExitCode check_mission(const RunRequest& request) {
  MissionOptions options;
  options.seed = request.seed;
  options.overrides = request.overrides;
  const Mission mission = load_mission(request.mission, options);
  for (const std::string& line : mission.printed) print_err("%s\n", line.c_str());
  const AssetLibrary assets = load_assets(mission, request.asset_packs);
  for (const std::string& warning : assets.warnings)
    print_err("warning: %s\n", warning.c_str());
  print_json(scenario_to_json(mission.scenario) + "\n");
  return ExitCode::done;
}

Action declare_check(CommandLine& line) {
  const auto request = std::make_shared<RunRequest>();
  add_mission_options(line, *request);
  add_seed_option(line, *request);
  line.add_print("--schema", mission_json_schema,
                 "Print a JSON Schema of every key of a mission instead");
  line.add_print("--annotations", lua_annotations,
                 "Print LuaCATS annotations instead, with which editors check and complete missions");
  return [request] { return check_mission(*request); };
}

}  // namespace

Command check_command() {
  return {"", "check", "Print the complete scenario as JSON; run nothing", declare_check};
}

}  // namespace rubble
