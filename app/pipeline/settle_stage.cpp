// The stage from what is dropped to what lies there.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "app/control/robot_control.h"
#include "app/fines/pile_fines.h"
#include "app/pipeline/stages.h"
#include "app/provenance/earlier_files.h"
#include "app/scene/build_scene.h"
#include "app/scene/look_pictures.h"
#include "app/simulators/build_sim_scene.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "app/surroundings/pile_surroundings.h"
#include "app/victims/place_victims.h"
#include "io/base/atomic_file.h"
#include "io/mesh/mesh_writers.h"
#include "io/scenes/pile_export.h"
#include "io/state/checkpoint_file.h"
#include "io/state/pile_state_file.h"
#include "io/state/track_file.h"
#include "kernel/base/hash.h"
#include "kernel/collision/placed_overlaps.h"
#include "kernel/settling/settle.h"
#include "kernel/settling/settle_checkpoint.h"
#include "kernel/settling/track_recorder.h"
#include "kernel/structure/building.h"

namespace rubble {
namespace {

// From here on an overlap of placed pieces is worth a word; unit: m
constexpr double kNotedPlacedOverlap = 0.005;
constexpr std::size_t kNotedOverlaps = 3;  // that are named

// Nobody sees such a thing in a picture, and what can move is thrown apart. Of fixed pieces the deepest pair is named.
void note_placed_overlaps(const ResolvedMission& mission, const Pile& pile, RunContext& context) {
  // The mission's own come first, before terrain and furniture.
  const std::size_t own = std::min(pile.placed.size(), mission.scenario.pile.placed.size());
  std::vector<Placement> placed(pile.placed.begin(), pile.placed.begin() + std::ptrdiff_t(own));
  if (own > 0 && pile.structures)
    for (const StructurePiece& piece : pile.structures->damaged.pieces)
      placed.push_back({pile.building_first_type + piece.type, 1, {{}, piece.position}, false});
  const auto name = [&](int i) {
    const Placement& placement = placed[std::size_t(i)];
    if (std::size_t(i) >= own) return pile.types[std::size_t(placement.kind.index)].name + " of the building";
    return "pile.placed[" + std::to_string(i + 1) + "] (" + pile.types[std::size_t(placement.kind.index)].name +
           (placement.fixed ? ", fixed)" : ")");
  };
  const auto is_built_in = [&](int i) { return std::size_t(i) < own && mission.scenario.pile.placed[std::size_t(i)].built_in; };
  std::size_t told = 0, fixed = 0;
  for (const PlacedOverlap& overlap : find_placed_overlaps(pile.types, placed, own, kNotedPlacedOverlap)) {
    const bool both_fixed = placed[std::size_t(overlap.a)].fixed && placed[std::size_t(overlap.b)].fixed;
    if (both_fixed && (is_built_in(overlap.a) || is_built_in(overlap.b))) continue;
    if (both_fixed ? fixed++ > 0 : told++ >= kNotedOverlaps) continue;
    char depth[32];
    std::snprintf(depth, sizeof depth, "%.0f mm", overlap.depth * 1000);
    context.warnings.push_back(name(overlap.a) + " and " + name(overlap.b) + " reach " + depth +
                               " into each other from the start");
  }
  const std::size_t more = (told > kNotedOverlaps ? told - kNotedOverlaps : 0) + (fixed > 1 ? fixed - 1 : 0);
  if (more > 0)
    context.warnings.push_back(std::to_string(more) + " more pairs with pieces of pile.placed reach into each other, less deep");
}

constexpr double kStandsWithin = 0.1;   // of its place as built: a piece that has not fallen; unit: m
constexpr double kFewPieces = 0.02;     // of a building's pieces: where no more fell, it did not collapse

bool has_cause(const CollapseCause& c) {
  return !c.removed.empty() || c.weak_storey >= 0 || c.overloaded_floor >= 0 || c.shake > 0 || c.blast > 0 ||
         c.vehicle.mass > 0 || !c.sinking.empty();
}

// A building that stands has come to rest, too, but nobody gives it a cause for that.
void note_standing_building(const ResolvedMission& mission, const PileState& state, RunContext& context) {
  if (!mission.assets.structures || !has_cause(mission.scenario.pile.building.cause)) return;
  const std::vector<StructurePiece>& pieces = mission.assets.structures->damaged.pieces;
  if (std::size_t(state.building.count) != pieces.size()) return;
  std::size_t fallen = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PieceState& piece = state.pieces[std::size_t(state.building.first) + i];
    fallen += distance(piece.world_from_body.translation, pieces[i].position) > kStandsWithin;
  }
  if (double(fallen) > kFewPieces * double(pieces.size())) return;
  context.warnings.push_back("pile.building.cause: the building did not collapse: " + std::to_string(fallen) + " of its " +
                             std::to_string(pieces.size()) + " pieces moved by more than 10 cm; a stronger cause brings it " +
                             "down, such as a smaller `weakness`, a higher `overload` or `shake`, or more columns `removed`");
}

void show_settling(const SettleProgress& p, const SettleOptions& options, Progress& progress) {
  const double limit = p.layer < p.layers ? options.layer_time_limit : options.final_time_limit;
  const double layer = std::min(1.0, p.layer_time / limit);
  const std::string pieces = std::to_string(p.pieces) + " pieces";
  progress.update((std::max(0, p.layer - 1) + layer) / std::max(1, p.layers),
                  (p.layers > 0 ? "layer " + std::to_string(p.layer) + " of " + std::to_string(p.layers) + ", " : "") +
                      (p.verifying ? "verifying that " + pieces + " rest"
                                   : std::to_string(p.awake) + " of " + pieces + " awake"));
}

// Shows how far it is, and keeps a checkpoint every few seconds of the clock on the wall: when one
// is made does not change what follows.
class SettleWatch {
 public:
  // track: goes with every checkpoint; null: none is recorded.
  SettleWatch(RunContext& context, const RunFolder& folder, const SettleOptions& options,
              const TrackRecorder* track)
      : context_(context), folder_(folder), options_(options), track_(track) {}

  bool step(const SettleProgress& p) {
    show_settling(p, options_, context_.progress);
    const auto now = std::chrono::steady_clock::now();
    const double since = std::chrono::duration<double>(now - kept_).count();
    if (p.make_checkpoint && (stop_requested() || since >= context_.options.checkpoint_every)) {
      keep(p.make_checkpoint());
      kept_ = std::chrono::steady_clock::now();
    }
    return !stop_requested();
  }

 private:
  // It is only an aid: the run goes on without one.
  void keep(const SettleCheckpoint& checkpoint) {
    // A kill between the two files leaves a track that knows more than the checkpoint, which does no
    // harm: what comes after the checkpoint is recorded again.
    try {
      if (track_) save_track(track_->track(), folder_.track_so_far_file());
      save_checkpoint(checkpoint, folder_.checkpoint_file());
    } catch (const RunError& error) {
      if (!warned_) print_err("warning: no checkpoint: %s\n", error.what());
      warned_ = true;
    }
  }

  RunContext& context_;
  const RunFolder& folder_;
  const SettleOptions& options_;
  const TrackRecorder* track_;
  std::chrono::steady_clock::time_point kept_ = std::chrono::steady_clock::now();
  bool warned_ = false;
};

// Whether there is all that settling goes on from.
bool has_checkpoint(const RunFolder& folder, bool recorded) {
  return folder.has("unfinished/settle.checkpoint") &&
         (!recorded || folder.has("unfinished/settle.track"));
}

SettledPile settle_from_checkpoint_or_start(const ResolvedMission& mission, const Pile& pile,
                                            const RunFolder& folder, RunContext& context) {
  SettleOptions options = mission.scenario.settle;
  options.threads = context.threads();
  const bool recorded = needs_track(mission.scenario);
  const bool goes_on = has_checkpoint(folder, recorded);
  TrackRecorder track;
  if (goes_on && recorded) track = TrackRecorder(load_track(folder.track_so_far_file()));
  SettleWatch watch(context, folder, options, recorded ? &track : nullptr);
  const auto step = [&watch](const SettleProgress& p) { return watch.step(p); };
  WorldObserver observe;
  if (recorded) observe = [&track](const World& world) { track.observe(world); };
  SettledPile settled;
  World world(pile.types, calc_world_options(options), pile.assemblies);
  settled.state = goes_on ? resume_settling(world, load_checkpoint(folder.checkpoint_file()), pile, options, step, observe)
                          : settle_pieces(world, mission, pile, options, step, observe);
  settled.track = track.take();
  return settled;
}

// What pile.bin is made from.
std::uint64_t hash_work_of(const ResolvedMission& mission, const Pile& pile) {
  std::uint64_t settling = hash_work(pile, mission.scenario.settle);
  if (mission.assets.snapshot) {
    StateHash from;
    from.add(settling);
    for (const char c : mission.assets.snapshot->sha256) from.add(std::int32_t(c));
    settling = from.digest();
  }
  const VictimScenario& victims = mission.scenario.victims;
  const FinesSpec& fines = mission.scenario.fines;
  if (victims.count == 0) return hash_fines_work(fines, mission.scenario.pile_seed(), settling);
  StateHash hash;
  hash.add(settling), hash.add(mission.scenario.pile_seed());
  hash.add(victims.count), hash.add(int(victims.difficulty)), hash.add(victims.radius);
  return hash_fines_work(fines, mission.scenario.pile_seed(), hash.digest());
}

// The pile is written last: where it is, all else of it is there and complete.
void save(const ResolvedMission& mission, const PileState& state, std::uint64_t work, const RunFolder& folder) {
  if (mission.scenario.victims.count > 0) write_text_file(folder.file("victims.json"), describe_victims(find_victims(state)));
  save_fines_of(mission.scenario.fines, state, folder.path());
  save_pile_state(state, folder.file("pile.bin"));
  folder.note_pile(work, state.deepest_overlap);
}

// Strews fines over the pile, with what a person sees of it. A million takes a minute or more, so a signal ends it.
void strew(const ResolvedMission& mission, RunContext& context, PileState& pile, const std::string& folder) {
  const int amount = mission.scenario.fines.amount;
  if (amount == 0) return;
  context.progress.start("fines");
  const auto show = [&](double done, int strewn) {
    throw_if_stopped(folder);
    context.progress.update(done, std::to_string(strewn) + " of " + std::to_string(amount));
  };
  const std::string warning = lay_fines(mission.scenario.fines, mission.scenario.pile_seed(), mission.assets, context.threads(), pile, show);
  if (!warning.empty()) context.warnings.push_back(warning);
  context.progress.finish(std::to_string(pile.fines.pieces.size() + pile.fines.sheets.size()) + " strewn");
}

SettledPile load(const FinesSpec& fines, bool recorded, const RunFolder& folder) {
  SettledPile settled;
  settled.state = load_pile_state(folder.file("pile.bin"));
  settled.state.deepest_overlap = folder.noted_overlap();
  load_fines_of(fines, folder.path(), settled.state);
  if (recorded) settled.track = load_track(folder.file("track.bin"));
  return settled;
}

std::string summarize_settling(const PileState& pile, bool loaded) {
  char text[160];
  std::snprintf(text, sizeof text, "%zu pieces %s after %.1f simulated s, %d lost",
                pile.pieces.size(), pile.settled ? "at rest" : "did not settle", pile.simulated,
                pile.lost);
  return text + std::string(loaded ? ", as settled before" : "");
}

}  // namespace

void add_victims(const ResolvedMission& mission, int threads, PileState& pile) {
  const Scenario& s = mission.scenario;
  with_lines_of_script(mission, [&] {
    place_victims(s.victims, mission.scenario.pile_seed(), s.settle.gravity, mission.assets, threads, pile);
    return 0;
  });
}

void keep_pile(const ResolvedMission& mission, const PileState& state, const RunFolder& folder) {
  save(mission, state, hash_work_of(mission, make_pile(mission)), folder);
}

SettledPile settle(const ResolvedMission& mission, RunFolder& folder, RunContext& context) {
  context.progress.start("settle");
  const Pile pile = make_pile(mission);
  const std::uint64_t work = hash_work_of(mission, pile);
  const bool recorded = needs_track(mission.scenario);
  const bool loaded = folder.has_pile_of(work) && (!recorded || folder.has("track.bin"));
  note_placed_overlaps(mission, pile, context);
  SettledPile settled = loaded ? load(mission.scenario.fines, recorded, folder)
                               : settle_from_checkpoint_or_start(mission, pile, folder, context);
  throw_if_stopped(folder.path());
  complete_pile(mission, context, settled.state, loaded, folder.path());
  add_pile_metrics(settled.state, mission.assets, settled.metrics);
  if (!loaded && recorded) save_track(settled.track, folder.file("track.bin"));
  if (!loaded) save(mission, settled.state, work, folder);
  folder.add("pile.bin");
  if (mission.scenario.victims.count > 0) folder.add("victims.json");
  if (mission.scenario.fines.amount > 0) folder.add(kFinesFile);
  if (recorded) folder.add("track.bin");
  return settled;
}

SettledPile settle_in_memory(const ResolvedMission& mission, RunContext& context,
                             const std::function<bool()>& go_on) {
  context.progress.start("settle");
  SettleOptions options = mission.scenario.settle;
  options.threads = context.threads();
  bool stopped = false;
  SettledPile settled;
  const Pile pile = make_pile(mission);
  World world(pile.types, calc_world_options(options), pile.assemblies);
  settled.state = settle_pieces(world, mission, pile, options, [&](const SettleProgress& p) {
    show_settling(p, options, context.progress);
    stopped = !go_on();
    return !stopped;
  });
  if (stopped) throw Stopped("stopped while the pile settled; nothing is kept");
  complete_pile(mission, context, settled.state);
  add_pile_metrics(settled.state, mission.assets, settled.metrics);
  return settled;
}

PileState settle_pieces(World& world, const ResolvedMission& mission, const Pile& pile, const SettleOptions& options,
                        const SettleCallback& step, const WorldObserver& observe) {
  if (!mission.assets.snapshot) return settle_pile(world, pile, options, step, observe);
  const SettleCheckpoint from = load_checkpoint(mission.assets.snapshot_file);
  if (from.work != hash_work(pile, options))
    throw with_lines(mission, InputError({"", 0, "pile.snapshot", "the snapshot is of another pile or of other settling options",
                                          "the mission, seed and `settle` that it was saved from",
                                          "\"" + mission.assets.snapshot->file + "\"", "leave out pile.snapshot to settle from the start"}));
  return resume_settling(world, from, pile, options, step, observe);
}

void complete_pile(const ResolvedMission& mission, RunContext& context, PileState& pile, bool loaded, const std::string& folder) {
  note_standing_building(mission, pile, context);
  if (!loaded) add_victims(mission, context.threads(), pile);
  context.progress.finish(summarize_settling(pile, loaded));
  if (!loaded) strew(mission, context, pile, folder);
  lay_surroundings(mission.scenario, mission.assets, pile);
}

void write_pile_files(const ResolvedMission& mission, const SettledPile& pile, RunFolder& folder,
                      RunContext& context) {
  const OutputScenario& outputs = mission.scenario.outputs;
  std::vector<std::string> formats = outputs.meshes;
  if (outputs.stl) formats.push_back("stl");
  if (formats.empty() && !outputs.track) return;
  context.progress.start("export");
  BuiltScene built;
  if (needs_scene(formats)) {
    const std::size_t warned = context.warnings.size();
    built = build_sim_scene(mission, pile.state, make_robots(mission, context), {}, context.threads());
    context.warnings.resize(warned);  // those of robots come when they are driven
    for (const std::string& note : list_notes(built, formats)) context.warnings.push_back("outputs.meshes: " + note);
  } else {
    built.model = build_mesh_model(mission.assets, pile.state, formats, context.threads());
  }
  for (const MeshFormat& format : mesh_formats())
    if (format.is_folder && std::find(formats.begin(), formats.end(), format.name) != formats.end())
      remove_folder_of_killed_run(folder.file(format.leaves.back()));
  for (const std::string& format : formats)
    for (const std::string& name : export_pile(built.model, format, folder.path())) folder.add(name);
  if (outputs.track) {
    PileModel moving = build_track_model(mission.assets, pile.state);
    add_look_pictures(moving, context.threads());
    write_track_glb(folder.file("track.glb"), moving, pile.track);
    folder.add("track.glb");
  }
  const std::size_t files = formats.size() + (outputs.track ? 1 : 0);
  context.progress.finish(std::to_string(files) + (files == 1 ? " mesh" : " meshes"));
}

}  // namespace rubble
