// A settled pile held awake: what a number of threads would gain in the sweeps over its contacts, by their plan. So the
// gain of many cores is known where there are few.
#pragma once

#include <string>
#include <vector>

#include "bench/settle_run.h"
#include "kernel/solver/sweep_figures.h"

namespace rubble {

inline constexpr int kSweepSteps = 10;  // that are planned

struct SweepRun {
  std::string work;
  Schedule schedule = Schedule::layers;
  bool settled = false;
  std::vector<SweepFigures> figures;  // by number of threads: sums over the steps
};

SweepRun run_sweeps(const Pile& pile, const SettleJob& job, const std::vector<int>& threads);

// A line of names and one for each number of threads. gain: of the sweeps alone, against the first number.
std::string sweep_csv(const SweepRun& run);

}  // namespace rubble
