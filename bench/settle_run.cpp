#include "bench/settle_run.h"

#include <cmath>

#include "bench/process_times.h"
#include "kernel/base/system/thread_count.h"

namespace rubble {
namespace {

void measure_drift(World& world, double step, SettleRun& run) {
  world.set_sleeping(false);
  const long steps = std::lround(kDriftTime / step);
  for (long i = 0; i < steps; ++i) world.step();
  for (int i = 0; i < world.size(); ++i) {
    const PieceState& before = run.state.pieces[std::size_t(i)];
    const PieceState after = world.piece(i);
    if (before.status == PieceStatus::lost || before.status == PieceStatus::fixed) continue;
    run.drift.push_back(
        distance(before.world_from_body.translation, after.world_from_body.translation));
    run.drifted.push_back(i);
  }
}

}  // namespace

SettleRun run_settling(const Pile& pile, const SettleJob& job) {
  SettleRun run;
  run.work = job.work;
  run.schedule = job.options.schedule;
  run.threads =
      job.options.threads > 0 ? job.options.threads : default_thread_count();
  const Times begin = read_times();
  World world(pile.types, calc_world_options(job.options), pile.assemblies);
  StageClock clock(world);
  EjectionWatch watch(world);
  LayerCosts layers;
  Times watching;  // is not the kernel's
  run.state = settle_pile(world, pile, job.options, [&](const SettleProgress& progress) {
    const Times before = read_times();
    layers.note(progress, before - begin - watching, clock.times());
    watch.look();
    watching += read_times() - before;
    return true;
  });
  const Times spent = read_times() - begin - watching;
  run.wall = spent.wall;
  run.cpu = spent.cpu;
  run.stages = clock.times();
  run.layers = layers.layers();
  run.peak_rss = read_peak_rss();
  run.ejected = watch.ejected();
  for (int i = 0; i < world.size(); ++i) run.masses.push_back(world.mass(i));
  if (!job.judge) return run;
  run.overlaps = check_overlaps(pile.types, run.state);
  if (job.drift) measure_drift(world, job.options.step, run);
  return run;
}

}  // namespace rubble
