// The stage from what is dropped to what lies there.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "app/pipeline/build_scene.h"
#include "app/pipeline/run.h"
#include "app/pipeline/void_metrics.h"
#include "app/support/stop.h"
#include "io/mesh/pile_export.h"
#include "io/state/checkpoint_file.h"
#include "io/state/pile_state_file.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/settling/settle_checkpoint.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

// Shows how far it is, and keeps a checkpoint every few seconds of the clock on the wall: when one
// is made does not change what follows.
class SettleWatch {
 public:
  SettleWatch(Run& run, const RunFolder& folder, const SettleOptions& options)
      : run_(run), folder_(folder), options_(options) {}

  bool step(const SettleProgress& p) {
    show(p);
    const auto now = std::chrono::steady_clock::now();
    const double since = std::chrono::duration<double>(now - kept_).count();
    if (stop_requested() || since >= run_.options.checkpoint_every) {
      keep(p.make_checkpoint());
      kept_ = std::chrono::steady_clock::now();
    }
    return !stop_requested();
  }

 private:
  void show(const SettleProgress& p) {
    const double limit = p.layer < p.layers ? options_.layer_time_limit : options_.final_time_limit;
    const double layer = std::min(1.0, p.layer_time / limit);
    run_.progress.update((std::max(0, p.layer - 1) + layer) / std::max(1, p.layers),
                         "layer " + std::to_string(p.layer) + " of " + std::to_string(p.layers) +
                             ", " + std::to_string(p.awake) + " of " + std::to_string(p.pieces) +
                             " pieces moving");
  }

  // It is only an aid: the run goes on without one.
  void keep(const SettleCheckpoint& checkpoint) {
    try {
      save_checkpoint(checkpoint, folder_.checkpoint_file());
    } catch (const RunError& error) {
      if (!warned_) std::fprintf(stderr, "warning: no checkpoint: %s\n", error.what());
      warned_ = true;
    }
  }

  Run& run_;
  const RunFolder& folder_;
  const SettleOptions& options_;
  std::chrono::steady_clock::time_point kept_ = std::chrono::steady_clock::now();
  bool warned_ = false;
};

PileState settle_from_checkpoint_or_start(Run& run, const RunFolder& folder, const Pile& pile) {
  SettleOptions options = run.pile_scenario.settle;
  options.threads = run.threads();
  SettleWatch watch(run, folder, options);
  const auto step = [&watch](const SettleProgress& p) { return watch.step(p); };
  if (!folder.has("unfinished/settle.checkpoint")) return settle_pile(pile, options, step);
  return resume_settling(load_checkpoint(folder.checkpoint_file()), pile, options, step);
}

std::uint64_t hash_pile_work(const Run& run, const Pile& pile) {
  return hash_work(pile, run.pile_scenario.settle);
}

void measure_voids(Run& run, const RunFolder& folder) {
  run.progress.start("voids");
  const auto report = [&](double done) {
    run.progress.update(done, "free space");
    throw_if_stopped(folder.path());
    return true;
  };
  add_void_metrics(run.scenario.voids, run.pile, run.assets, run.threads(), report, run.metrics);
  run.progress.finish(format_number(run.metrics["void_volume_m3"]) + " m3");
}

}  // namespace

void keep_pile(const Run& run, const PileState& state, const RunFolder& folder) {
  const Pile pile = generate_pile(build_pile_spec(run.pile_scenario, run.assets));
  save_pile_state(state, folder.file("pile.bin"));
  folder.note_pile(hash_pile_work(run, pile));
}

void settle(Run& run, RunFolder& folder) {
  run.progress.start("settle");
  const Pile pile = generate_pile(build_pile_spec(run.pile_scenario, run.assets));
  const std::uint64_t work = hash_pile_work(run, pile);
  const bool loaded = folder.has_pile_of(work);
  run.pile = loaded ? load_pile_state(folder.file("pile.bin"))
                    : settle_from_checkpoint_or_start(run, folder, pile);
  throw_if_stopped(folder.path());
  if (!loaded) {
    save_pile_state(run.pile, folder.file("pile.bin"));
    folder.note_pile(work);
  }
  folder.add("pile.bin");
  add_pile_metrics(run.pile, run.assets, run.metrics);
  char text[160];
  std::snprintf(text, sizeof text, "%zu pieces %s after %.1f simulated s, %d lost",
                run.pile.pieces.size(), run.pile.settled ? "at rest" : "did not settle",
                run.pile.simulated, run.pile.lost);
  run.progress.finish(text + std::string(loaded ? ", as settled before" : ""));
  if (run.scenario.voids.on) measure_voids(run, folder);
}

void write_pile_files(Run& run, RunFolder& folder) {
  std::vector<std::string> formats = run.scenario.outputs.meshes;
  if (run.scenario.outputs.stl) formats.push_back("stl");
  if (formats.empty()) return;
  run.progress.start("export");
  const PileModel model = build_pile_model(run.assets, run.pile);
  for (const std::string& format : formats)
    for (const std::string& name : export_pile(model, format, folder.path())) folder.add(name);
  run.progress.finish(std::to_string(formats.size()) + (formats.size() == 1 ? " mesh" : " meshes"));
}

}  // namespace rubble
