#include "bench/sweep_run.h"

#include <cstdio>

#include "bench/report.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_rest.h"

namespace rubble {
namespace {

void add(const SweepFigures& f, SweepFigures& sum) {
  sum.threads = f.threads;
  sum.contacts += f.contacts, sum.batches += f.batches, sum.chain += f.chain;
  sum.waits += f.waits, sum.work += f.work, sum.longest += f.longest, sum.time += f.time;
}

}  // namespace

SweepRun run_sweeps(const Pile& pile, const SettleJob& job, const std::vector<int>& threads) {
  World world(pile.types, calc_world_options(job.options), pile.assemblies);
  SweepRun run;
  run.work = job.work, run.schedule = job.options.schedule;
  run.settled = settle_pile(world, pile, job.options).settled;
  run.figures.resize(threads.size());
  world.set_sleeping(false);
  world.step();  // wakes everybody
  for (int step = 0; step < kSweepSteps; ++step) {
    world.step();
    for (std::size_t i = 0; i < threads.size(); ++i) add(world.diagnostics().plan_sweeps(threads[i]), run.figures[i]);
  }
  return run;
}

std::string sweep_csv(const SweepRun& run) {
  std::string text =
      "work,schedule,threads,contacts,batches,chain,work_rows,longest_rows,time_rows,waits,idle_percent,gain\n";
  for (const SweepFigures& f : run.figures) {
    const double steps = kSweepSteps, time = double(f.time);
    char line[256];
    std::snprintf(line, sizeof line, "%s,%s,%d,%.0f,%.1f,%.1f,%.0f,%.0f,%.0f,%.0f,%.1f,%.2f\n", run.work.c_str(),
                  name_of(run.schedule).c_str(), f.threads, f.contacts / steps, f.batches / steps,
                  f.chain / steps, double(f.work) / steps, double(f.longest) / steps, time / steps, f.waits / steps,
                  time > 0 ? 100 * (1 - double(f.work) / (time * f.threads)) : 0,
                  time > 0 ? double(run.figures[0].time) / time : 1);
    text += line;
  }
  return text;
}

}  // namespace rubble
