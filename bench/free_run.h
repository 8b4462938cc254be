// A number of steps of a pile whose pieces are all there from the start, as the benches of other engines do it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/settle_run.h"

namespace rubble {

struct FreeRun {
  std::string work;
  int threads = 1;
  int pieces = 0;  // that move
  int steps = 0;
  bool sleeps = true;                 // pieces may fall asleep
  std::int64_t awake_body_steps = 0;  // pieces awake, summed over the steps
  double wall = 0, cpu = 0;           // of a step, mean; unit: ms
  double slowest = 0;                 // of a step, wall; unit: ms
  double fastest_piece = 0;           // at the end; unit: m/s
  OverlapReport overlaps;             // at the end, between pieces
  double peak_rss = 0;                // of the process up to here; unit: MiB
  std::uint64_t state_hash = 0;       // at the end
};

// Heights of the layers are taken as heights above the ground. One run for each number of threads. Throws RunError when
// the states at the end differ.
std::vector<FreeRun> run_free(const Pile& pile, const SettleJob& job, int steps, bool sleeps, const std::vector<int>& threads);

std::string free_csv_header();
std::string free_csv_line(const FreeRun& run);
std::string free_text(const FreeRun& run);  // three lines for people

}  // namespace rubble
