#include "bench/settle_run.h"

#include <sys/resource.h>

#include <cmath>
#include <ctime>
#include <thread>

namespace rubble {
namespace {

double read_clock(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Times {
  double wall = 0, cpu = 0;

  Times operator-(const Times& t) const { return {wall - t.wall, cpu - t.cpu}; }
  Times& operator+=(const Times& t) { return wall += t.wall, cpu += t.cpu, *this; }
};

Times now() { return {read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_PROCESS_CPUTIME_ID)}; }

double read_peak_rss() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;  // Linux: KiB
}

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
      job.options.threads > 0 ? job.options.threads : int(std::thread::hardware_concurrency());
  const Times begin = now();
  World world(pile.types, calc_world_options(job.options), pile.assemblies);
  EjectionWatch watch(world);
  Times watching;  // is not the kernel's
  run.state = settle_pile(world, pile, job.options, [&](const SettleProgress&) {
    const Times before = now();
    watch.look();
    watching += now() - before;
    return true;
  });
  const Times spent = now() - begin - watching;
  run.wall = spent.wall;
  run.cpu = spent.cpu;
  run.stages = world.times();
  run.peak_rss = read_peak_rss();
  run.ejected = watch.ejected();
  for (int i = 0; i < world.size(); ++i) run.masses.push_back(world.mass(i));
  if (!job.judge) return run;
  run.overlaps = check_overlaps(pile.types, run.state);
  if (job.drift) measure_drift(world, job.options.step, run);
  return run;
}

}  // namespace rubble
