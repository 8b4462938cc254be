// A settled pile held awake: what a step costs when nothing sleeps, on one thread and on more.
// Sleep is what makes settling cheap; engines are compared without it here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/settle_run.h"

namespace rubble {

inline constexpr int kHoldSteps = 120;

struct HoldRun {
  std::string work;
  Schedule schedule = Schedule::layers;  // of the settling before
  int threads = 1;                       // while held
  int pieces = 0;
  bool settled = false;
  std::int64_t awake_body_steps = 0;  // pieces awake, summed over the steps
  double wall = 0, cpu = 0;           // of a step, mean; unit: ms
  double wall_median = 0;             // of a step; unit: ms
  double peak_rss = 0;                // of the process up to here; unit: MiB
  std::uint64_t state_hash = 0;       // after the last step
};

// Settles the pile once, then steps it kHoldSteps times with sleep off for each number of threads,
// each time from the same settled state. The first step awake, which wakes everybody, does not
// count. Throws RunError when the states at the end differ.
std::vector<HoldRun> run_hold(const Pile& pile, const SettleJob& job,
                              const std::vector<int>& threads);

std::string hold_csv_header();
std::string hold_csv_line(const HoldRun& run);
std::string hold_text(const HoldRun& run);  // two lines for people

}  // namespace rubble
