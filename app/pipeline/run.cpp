#include "app/pipeline/run.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/control/robot_control.h"
#include "app/pipeline/live.h"
#include "app/estimate/preview.h"
#include "app/provenance/earlier_files.h"
#include "app/provenance/manifest.h"
#include "app/support/build_info.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"

namespace rubble {
namespace {

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

bool is_lost(const PieceState& piece) { return piece.status == PieceStatus::lost; }

// Of the pieces that left the world the number, and where the first was seen last. There is one.
std::string describe_lost(const PileState& pile, const SettleOptions& options) {
  const auto first = std::find_if(pile.pieces.begin(), pile.pieces.end(), is_lost);
  const Vec3& p = first->world_from_body.translation;
  char text[400];
  std::snprintf(text, sizeof text,
                "%d of %zu pieces left the world, the first %s, piece %td, last seen with its origin at {%.2f, %.2f, %.2f}: "
                "lower than settle.lost_below = %g m, or farther than settle.lost_beyond = %g m from the Z axis",
                pile.lost, pile.pieces.size(), pile.types[std::size_t(first->type)].c_str(), first - pile.pieces.begin(), p.x,
                p.y, p.z, options.lost_below, options.lost_beyond);
  return text;
}

ExitCode report(const ResolvedMission& mission, const PileState& pile, const RunFolder& folder) {
  print_out("%s\n", folder.path().c_str());
  const SettleOptions& options = mission.scenario.settle;
  const bool lost = std::any_of(pile.pieces.begin(), pile.pieces.end(), is_lost);
  if (lost) print_err("%s\n", describe_lost(pile, options).c_str());
  const double depth = pile.deepest_overlap.depth;
  if (pile.settled) {
    if (depth > kNotedOverlap) {
      print_err("warning: %s; settle.rest_overlap = %g m allows it\n",
                describe_overlap(pile).c_str(), options.rest_overlap);
    }
    return lost ? ExitCode::did_not_settle : ExitCode::done;
  }
  const std::string why =
      depth > options.rest_overlap ? describe_overlap(pile) : describe_moving(pile);
  print_err("the pile did not settle: %s when the time limit came "
            "(settle.final_time_limit = %g s)\n",
            why.c_str(), options.final_time_limit);
  return ExitCode::did_not_settle;
}

}  // namespace

std::string choose_output(const RunRequest& request) {
  if (!request.out.empty()) return request.out;
  return "out/" + std::filesystem::path(request.mission).stem().string();
}

void warn_of_derived_files(const std::string& folder) {
  std::string names;
  for (const std::string& name : find_derived_files(folder)) names += (names.empty() ? "" : ", ") + name;
  if (!names.empty())
    print_err("warning: in %s, %s %s made of the earlier run and not of this one: make %s anew (`rubble voids --force` and "
              "others), or remove %s\n",
              folder.c_str(), names.c_str(), names.find(',') == std::string::npos ? "was" : "were",
              names.find(',') == std::string::npos ? "it" : "them", names.find(',') == std::string::npos ? "it" : "them");
}

ExitCode run_to_folder(const RunRequest& request, RunKind kind) {
  stop_on_signals();
  check_live(request.options);
  RunContext context(request.options);
  const ResolvedMission mission = resolve_mission(request, kind, context);
  check_robot_models(mission.scenario, mission.assets, mission.provenance.script);
  const RunPreview preview = preview_run(kind, mission.scenario, mission.assets, choose_output(request));
  if (request.preview) {
    print_out("%s%s\n", describe_files(kind, mission.scenario, mission.assets).c_str(), describe(preview).c_str());
    return ExitCode::done;
  }
  if (!request.options.quiet) print_err("%s\n", describe(preview).c_str());
  if (preview.bytes / 20 > preview.free)
    throw InputError({choose_output(request), 0, "", "the disk is far too small for this run",
                      "room for the files", describe(preview), "fewer frames, smaller pictures or fewer outputs"});
  if (preview.bytes > preview.free)
    print_err("warning: the disk may be too small for this run\n");
  RunFolder folder = RunFolder::create(choose_output(request), request.force);
  if (request.force) warn_of_derived_files(folder.path());
  const ExitCode code = complete(mission, folder, context);
  note_speed(preview, context.progress);
  return code;
}

Metrics join(const Metrics& a, const Metrics& b) {
  Metrics all = a;
  all.insert(b.begin(), b.end());
  return all;
}

void write_manifest(const ResolvedMission& mission, const PileState& pile, const Metrics& metrics,
                    const RecordedFrames& frames, RunFolder& folder, const RunContext& context) {
  Manifest manifest;
  manifest.program = build_info();
  manifest.provenance = mission.provenance;
  manifest.seed = mission.scenario.seed;
  manifest.pile = summarize(pile);
  manifest.frames = frames.hashes.compact();
  manifest.metrics = metrics;
  manifest.warnings = mission.assets.warnings;  // of the mission and what it loads; the others are of the run
  manifest.warnings.insert(manifest.warnings.end(), context.warnings.begin(), context.warnings.end());
  manifest.outputs = folder.hash_files(context.threads());
  manifest.wall_seconds = context.progress.wall_seconds();
  manifest.environment = frames.environment;
  manifest.pack_folders = mission.assets.folders;
  write_text_file(folder.file("manifest.json"), manifest_to_json(manifest));
}

StageResults run_stages(const ResolvedMission& mission, RunFolder& folder, RunContext& context,
                        bool with_frames, const PileCheck& check) {
  StageResults results;
  SettledPile pile = settle(mission, folder, context);
  const bool goes_on = !check || check(pile);
  if (goes_on) {
    PileSurvey survey(mission.assets, pile.state, context.threads());
    results.metrics = join(pile.metrics, measure_voids(mission, survey, folder, context));
    write_pile_files(mission, pile, folder, context);
    if (with_frames) {
      const DrivenRobots robots = drive_robots(mission, pile, folder, context);
      const std::vector<Leg> legs = plan_flight(mission, pile, robots, survey, folder, context);
      results.frames = record_frames(mission, pile, robots, legs, folder, context);
      results.metrics = join(join(results.metrics, robots.metrics), results.frames.metrics);
    }
  }
  results.pile = std::move(pile.state);
  return results;
}

ExitCode complete(const ResolvedMission& mission, RunFolder& folder, RunContext& context) {
  folder.begin(describe_unfinished(mission));
  StageResults results;
  try {
    results = run_stages(mission, folder, context, mission.provenance.kind != RunKind::settle);
    write_manifest(mission, results.pile, results.metrics, results.frames, folder, context);
  } catch (const RunError& error) {
    throw RunError(error.what() + std::string("\nfinished work is kept: `rubble resume ") +
                   folder.path() + "` continues");
  }
  for (const std::string& warning : context.warnings)
    print_err("warning: %s\n", warning.c_str());
  folder.finish();
  return report(mission, results.pile, folder);
}

}  // namespace rubble
