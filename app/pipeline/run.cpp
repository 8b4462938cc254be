#include "app/pipeline/run.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/pipeline/finished_run.h"
#include "app/provenance/manifest.h"
#include "app/support/build_info.h"
#include "app/support/json_members.h"
#include "io/base/atomic_file.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRunFormat = "rubble unfinished run 1";

MissionOptions mission_options(const RunRequest& request) {
  MissionOptions options;
  options.seed = request.seed;
  options.overrides = request.overrides;
  return options;
}

void finish_assets(Run& run) {
  for (const std::string& warning : run.assets.warnings)
    std::fprintf(stderr, "warning: %s\n", printable(warning).c_str());
  run.progress.finish(std::to_string(run.assets.types.size()) + " loaded, seed " +
                      std::to_string(run.scenario.seed));
}

Mission load_and_print(const RunRequest& request) {
  Mission mission = load_mission(request.mission, mission_options(request));
  for (const std::string& line : mission.printed) std::fprintf(stderr, "%s\n", line.c_str());
  return mission;
}

// The same program, or the rest might not fit what is there.
void check_program(const Json& json, const std::string& file) {
  const BuildInfo build = build_info();
  const Json now = {{"version", build.version},   {"commit", build.commit},
                    {"compiler", build.compiler}, {"flags", build.flags},
                    {"target", build.target},     {"libraries", build.libraries}};
  const Json began = json.value("program", Json::object());
  for (const auto& [name, value] : now.items())
    if (!began.contains(name) || began[name] != value)
      throw InputError({file, 0, name, "another program began this run",
                        began.contains(name) ? began[name].dump() : "", value.dump(),
                        "continue with that one, or begin anew: `rubble run ... --force`"});
}

Json describe_program() {
  const BuildInfo build = build_info();
  return {{"version", build.version}, {"commit", build.commit}, {"compiler", build.compiler},
          {"flags", build.flags},     {"target", build.target}, {"libraries", build.libraries}};
}

std::string describe_moving(const PileState& pile) {
  std::string first;
  int moving = 0;
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    if (piece.status != PieceStatus::moving || ++moving > 1) continue;
    const Vec3& p = piece.world_from_body.translation;
    char text[160];
    std::snprintf(text, sizeof text, ", the first %s, piece %zu, at {%.2f, %.2f, %.2f},",
                  pile.types[std::size_t(piece.type)].c_str(), i, p.x, p.y, p.z);
    first = text;
  }
  if (moving == 0) return "all pieces are slow, but rest was not proved yet";
  return std::to_string(moving) + " of " + std::to_string(pile.pieces.size()) +
         " pieces still moved" + first;
}

// From here on an overlap is worth a word; unit: m
constexpr double kNotedOverlap = 0.005;

std::string describe_overlap(const PileState& pile) {
  const DeepestOverlap& o = pile.deepest_overlap;
  const auto name = [&pile](std::int32_t piece) {
    if (piece < 0) return std::string("the ground");
    const std::string& type = pile.types[std::size_t(pile.pieces[std::size_t(piece)].type)];
    return type + " (piece " + std::to_string(piece) + ")";
  };
  char depth[32];
  std::snprintf(depth, sizeof depth, "%.0f mm", o.depth * 1000);
  return name(o.piece_a) + " and " + name(o.piece_b) + " reach " + depth + " into each other";
}

ExitCode report(const Run& run, const RunFolder& folder) {
  std::printf("%s\n", folder.path().c_str());
  const SettleOptions& options = run.pile_scenario.settle;
  const double depth = run.pile.deepest_overlap.depth;
  if (run.pile.settled) {
    if (depth > kNotedOverlap) {
      std::fprintf(stderr, "warning: %s; settle.rest_overlap = %g m allows it\n",
                   describe_overlap(run.pile).c_str(), options.rest_overlap);
    }
    return ExitCode::done;
  }
  const std::string why = depth > options.rest_overlap ? describe_overlap(run.pile)
                                                       : describe_moving(run.pile);
  std::fprintf(stderr, "the pile did not settle: %s when the time limit came "
               "(settle.final_time_limit = %g s)\n",
               why.c_str(), options.final_time_limit);
  return ExitCode::did_not_settle;
}

}  // namespace

Run::Run(const RunOptions& o, Recipe r)
    : options(o),
      progress(choose_progress_style(o.quiet)),
      recipe(std::move(r)),
      scenario(stated_scenario(recipe)),
      pile_scenario(recipe.pile_from ? stated_scenario(*recipe.pile_from) : scenario) {}

int Run::threads() const {
  if (options.threads > 0) return options.threads;
  return std::max(1, int(std::thread::hardware_concurrency()));
}

Run start_run(const RunRequest& request, RunKind kind) {
  const Mission mission = load_and_print(request);
  Run run(request.options, make_recipe(kind, mission, mission_options(request)));
  run.progress.start("assets");
  run.assets = load_assets(mission, request.asset_packs);
  run.recipe.assets = run.assets.contents;
  finish_assets(run);
  return run;
}

Run start_run(const RunOptions& options, const Recipe& recipe,
              const std::vector<std::string>& pack_folders) {
  Run run(options, recipe);
  run.progress.start("assets");
  run.assets = load_assets(recipe, pack_folders);
  finish_assets(run);
  return run;
}

Run start_render(const RunRequest& request, const SavedRun& saved) {
  const Recipe& source = saved.manifest.recipe;
  Mission mission = load_and_print(request);
  const std::shared_ptr<const Recipe> pile_from =
      source.pile_from ? source.pile_from : std::make_shared<const Recipe>(source);
  adopt_pile(mission.scenario, stated_scenario(*pile_from));
  Recipe recipe = make_recipe(RunKind::render, mission, mission_options(request));
  recipe.assets = pile_from->assets;
  recipe.pile_from = pile_from;
  Run run(request.options, std::move(recipe));
  run.progress.start("assets");
  run.assets = load_assets_of(saved, request.asset_packs);
  finish_assets(run);
  return run;
}

void write_manifest(const Run& run, RunFolder& folder) {
  Manifest manifest;
  manifest.program = build_info();
  manifest.recipe = run.recipe;
  manifest.seed = run.scenario.seed;
  manifest.pile = summarize(run.pile);
  manifest.frames = run.frames.compact();
  manifest.metrics = run.metrics;
  manifest.warnings = run.warnings;
  manifest.outputs = folder.hash_files(run.threads());
  manifest.wall_seconds = run.progress.wall_seconds();
  manifest.environment = run.environment;
  manifest.pack_folders = run.assets.folders;
  write_text_file(folder.file("manifest.json"), manifest_to_json(manifest));
}

ExitCode complete(Run& run, RunFolder& folder) {
  folder.begin(describe_unfinished(run));
  try {
    settle(run, folder);
    write_pile_files(run, folder);
    if (run.recipe.kind != RunKind::settle) render_frames(run, folder);
    write_manifest(run, folder);
  } catch (const RunError& error) {
    throw RunError(error.what() + std::string("\nwhat is finished is kept: `rubble resume ") +
                   folder.path() + "` continues");
  }
  folder.finish();
  return report(run, folder);
}

std::string describe_unfinished(const Run& run) {
  Json json;
  json["format"] = kRunFormat;
  json["program"] = describe_program();
  add_recipe(json, run.recipe);
  json["pack_folders"] = run.assets.folders;
  // The name of a folder may be no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Run continue_run(const RunOptions& options, const RunFolder& folder,
                 const std::vector<std::string>& pack_folders) {
  const std::string file = folder.run_file();
  const Json json = parse_json_text(read_whole_file(file), file);
  const JsonMembers members(json, file);
  if (members.text("format") != kRunFormat) members.fail("format", kRunFormat);
  check_program(json, file);
  std::vector<std::string> folders = pack_folders;
  for (const JsonMembers& pack : members.list("pack_folders")) folders.push_back(pack.as_text());
  return start_run(options, recipe_from_json(json, file), folders);
}

}  // namespace rubble
