#include "app/mission/resolved_mission.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/mission/finished_run.h"
#include "app/mission/kept_pile.h"
#include "app/scene/build_scene.h"
#include "app/support/build_info.h"
#include "app/support/drawing_device.h"
#include "app/support/json_members.h"
#include "app/support/print.h"
#include "app/victims/place_victims.h"
#include "io/base/atomic_file.h"
#include "kernel/settling/generator.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/sandbox/source_map.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRunFormat = "rubble unfinished run 1";

// What a person asked to draw, as a key of the mission: so the manifest says it. --set overrides the variable.
std::vector<std::string> device_override(const RunRequest& request) {
  const std::optional<AskedDevice> asked = asked_device(request.options.device);
  for (const std::string& text : request.overrides) {
    if (text.compare(0, 7, "device=") != 0) continue;
    if (request.options.device.empty()) return {};
    throw InputError({"", 0, "--device", "is given beside --set " + text, "one of them", request.options.device, ""});
  }
  if (!asked) return {};
  return {"device=" + device_names()[std::size_t(asked->kind)]};
}

Mission load_and_print(const RunRequest& request) {
  Mission mission = load_mission(request.mission, mission_options(request));
  for (const std::string& line : mission.printed) print_err("%s\n", line.c_str());
  return mission;
}

// Loads the assets by `load`, with what a person sees of it.
template <typename Load>
void load_with_progress(ResolvedMission& mission, RunContext& context, const Load& load) {
  context.progress.start("assets");
  mission.assets = load();
  print_warnings(mission.assets.warnings);
  context.progress.finish(std::to_string(mission.assets.types.size()) + " loaded, seed " +
                          std::to_string(mission.scenario.seed));
}

Json describe_program() {
  const BuildInfo build = build_info();
  return {{"version", build.version}, {"commit", build.commit}, {"compiler", build.compiler},
          {"flags", build.flags},     {"target", build.target}, {"libraries", build.libraries},
          {"simbody_bits", build.simbody_bits}};
}

// The same program, or the rest might not fit what is there.
void check_program(const Json& json, const std::string& file) {
  const Json now = describe_program();
  const Json began = json.value("program", Json::object());
  for (const auto& [name, value] : now.items())
    if (!began.contains(name) || began[name] != value)
      throw InputError({file, 0, name, "another program began this run",
                        began.contains(name) ? began[name].dump() : "", value.dump(),
                        "continue with that program, or start again: `rubble run ... --force`"});
}

}  // namespace

MissionOptions mission_options(const RunRequest& request) {
  for (const std::string& text : request.overrides)
    if (request.seed && text.compare(0, 5, "seed=") == 0)
      throw InputError({"", 0, "--seed", "is given beside --set " + text, "one of them", std::to_string(*request.seed), ""});
  MissionOptions options;
  options.seed = request.seed;
  options.overrides = device_override(request);
  options.overrides.insert(options.overrides.end(), request.overrides.begin(), request.overrides.end());
  if (request.track) options.overrides.push_back("outputs.track=true");
  return options;
}

ResolvedMission resolve_mission(const RunRequest& request, RunKind kind, RunContext& context) {
  const Mission loaded = load_and_print(request);
  ResolvedMission mission;
  mission.provenance = make_provenance(kind, loaded, mission_options(request));
  mission.scenario = loaded.scenario;
  load_with_progress(mission, context, [&] { return load_assets(loaded, request.asset_packs); });
  mission.provenance.assets = mission.assets.contents;
  mission.provenance.robots = mission.assets.robots;
  mission.provenance.snapshot = mission.assets.snapshot;
  return mission;
}

ResolvedMission resolve_pile(const Provenance& provenance, const std::vector<std::string>& pack_folders,
                             RunContext& context) {
  ResolvedMission mission;
  mission.provenance = provenance;
  mission.scenario = stated_scenario(provenance);
  load_with_progress(mission, context, [&] { return load_assets(provenance, pack_folders); });
  return mission;
}

ResolvedMission resolve_mission(const Provenance& provenance,
                                const std::vector<std::string>& pack_folders, RunContext& context) {
  ResolvedMission mission = resolve_pile(provenance, pack_folders, context);
  recall_robots(provenance, pack_folders, mission.assets);
  recall_snapshot(provenance, pack_folders, mission.assets);
  return mission;
}

ResolvedMission resolve_render(const RunRequest& request, const FinishedRun& saved,
                               RunContext& context) {
  const Provenance& source = saved.manifest.provenance;
  Mission loaded = load_and_print(request);
  const std::shared_ptr<const Provenance> pile_from =
      source.pile_from ? source.pile_from : std::make_shared<const Provenance>(source);
  ResolvedMission mission;
  const Scenario pile_source = stated_scenario(*pile_from), stated = loaded.scenario;
  adopt_pile(loaded.scenario, pile_source);
  const std::string kept = describe_kept_pile(stated, loaded.scenario, mission_options(request).overrides, saved.folder);
  if (!kept.empty()) context.warnings.push_back(kept);
  mission.scenario = loaded.scenario;
  mission.provenance = make_provenance(RunKind::render, loaded, mission_options(request));
  mission.provenance.assets = pile_from->assets;
  mission.provenance.pile_from = pile_from;
  load_with_progress(mission, context, [&] {
    AssetLibrary assets = load_assets_of(saved, request.asset_packs);
    for (std::string& warning : find_suspicious(loaded)) assets.warnings.push_back(std::move(warning));
    return assets;
  });
  add_robot_files(mission.scenario.robots, {std::filesystem::path(request.mission).parent_path().string()}, mission.assets);
  mission.provenance.robots = mission.assets.robots;
  return mission;
}

std::string describe_unfinished(const ResolvedMission& mission) {
  Json json;
  json["format"] = kRunFormat;
  json["program"] = describe_program();
  add_provenance(json, mission.provenance);
  json["pack_folders"] = mission.assets.folders;
  // The name of a folder may be no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ResolvedMission resolve_unfinished(const RunFolder& folder,
                                   const std::vector<std::string>& pack_folders,
                                   RunContext& context) {
  const std::string file = folder.run_file();
  const Json json = parse_json_text(read_whole_file(file), file);
  const JsonMembers members(json, file);
  if (members.text("format") != kRunFormat) members.fail("format", kRunFormat);
  check_program(json, file);
  std::vector<std::string> folders = pack_folders;
  for (const JsonMembers& pack : members.list("pack_folders")) folders.push_back(pack.as_text());
  return resolve_mission(provenance_from_json(json, file), folders, context);
}

Pile make_pile(const ResolvedMission& mission) {
  return with_lines_of_script(
      mission, [&] { return generate_pile(build_pile_spec(mission.scenario.pile, mission.scenario.pile_seed(), mission.assets)); });
}

Pile make_laid_pile(const ResolvedMission& mission, const PileState& state) {
  Pile pile = make_pile(mission);
  list_victims(state, mission.scenario.victims.count, pile);
  return pile;
}

InputError with_lines(const ResolvedMission& mission, const InputError& error) {
  std::vector<Diagnostic> mistakes = error.diagnostics();
  const SourceFile& script = mission.provenance.script;
  // Those of other files keep their lines.
  if (std::any_of(mistakes.begin(), mistakes.end(), [](const Diagnostic& d) { return d.file.empty() && d.line == 0; }))
    locate(mistakes, script.path, SourceMap(script.text, "mission"));
  return InputError(std::move(mistakes));
}

}  // namespace rubble
