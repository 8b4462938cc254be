#include "bench/hold_run.h"

#include <algorithm>
#include <cstdio>

#include "bench/process_times.h"
#include "bench/report.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

std::uint64_t hash_of(const World& world) {
  PileState state;
  state.pieces = world.pieces();
  return state.state_hash();
}

HoldRun hold(const Pile& pile, const SettleJob& job, const World::Snapshot& settled, int threads) {
  WorldOptions options = calc_world_options(job.options);
  options.threads = threads;
  World world(pile.types, options, pile.assemblies);
  world.restore(settled);
  world.set_sleeping(false);
  world.step();
  HoldRun run;
  run.work = job.work;
  run.schedule = job.options.schedule;
  run.threads = threads;
  run.pieces = world.size();
  std::vector<double> single;
  Times sum;
  for (int i = 0; i < kHoldSteps; ++i) {
    const Times before = read_times();
    world.step();
    const Times spent = read_times() - before;
    sum += spent;
    single.push_back(1e3 * spent.wall);
    run.awake_body_steps += world.awake_count();
  }
  std::sort(single.begin(), single.end());
  run.wall = 1e3 * sum.wall / kHoldSteps, run.cpu = 1e3 * sum.cpu / kHoldSteps;
  run.wall_median = single[single.size() / 2];
  run.peak_rss = read_peak_rss();
  run.state_hash = hash_of(world);
  return run;
}

std::string format(const char* pattern, const HoldRun& run) {
  const double body_steps = double(std::max<std::int64_t>(run.awake_body_steps, 1));
  char text[512];
  std::snprintf(text, sizeof text, pattern, run.work.c_str(), name_of(run.schedule).c_str(),
                run.threads, run.pieces, int(run.settled), kHoldSteps,
                (long long)run.awake_body_steps, run.wall, run.cpu, run.wall_median,
                1e3 * run.wall * kHoldSteps / body_steps, run.peak_rss,
                hex64(run.state_hash).c_str());
  return text;
}

}  // namespace

std::vector<HoldRun> run_hold(const Pile& pile, const SettleJob& job,
                              const std::vector<int>& threads) {
  std::shared_ptr<const World::Snapshot> snapshot;
  bool settled = false;
  {
    World world(pile.types, calc_world_options(job.options), pile.assemblies);
    settled = settle_pile(world, pile, job.options).settled;
    snapshot = world.snapshot();
  }
  std::vector<HoldRun> runs;
  for (int count : threads) {
    runs.push_back(hold(pile, job, *snapshot, count));
    runs.back().settled = settled;
    if (runs.back().state_hash != runs.front().state_hash) {
      throw RunError(
          "the state held awake depends on the number of threads: the same work must "
          "give the same bits");
    }
  }
  return runs;
}

std::string hold_csv_header() {
  return "work,schedule,threads,pieces,settled,steps,awake_body_steps,hold_ms_per_step,"
         "hold_cpu_ms_per_step,hold_median_ms_per_step,hold_us_per_awake_body_step,peak_rss_mib,"
         "state_hash";
}

std::string hold_csv_line(const HoldRun& run) {
  return format("%s,%s,%d,%d,%d,%d,%lld,%.4f,%.4f,%.4f,%.4f,%.1f,%s", run);
}

std::string hold_text(const HoldRun& run) {
  return format(
      "%s by %s, held awake on %d threads: %d pieces (settled: %d), %d steps, "
      "%lld piece-steps awake\n"
      "  ms a step: wall %.3f, CPU %.3f, median %.3f; us per awake piece %.3f; "
      "peak memory %.0f MiB; state %s\n",
      run);
}

}  // namespace rubble
