// The standard work beside busy loops, as on a machine that others use, too: what more threads cost or gain there.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "bench/settle_run.h"

namespace rubble {

// Threads that do nothing, as fast as they can, until the end of its life.
class BusyLoops {
 public:
  explicit BusyLoops(int count);
  ~BusyLoops();
  BusyLoops(const BusyLoops&) = delete;
  BusyLoops& operator=(const BusyLoops&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

struct BusyRun {
  int loops = 0, threads = 1;
  std::vector<double> walls;  // of each repetition, ascending; unit: s

  double median() const { return walls.at(walls.size() / 2); }
};

// Settles the pile on each number of threads in turn, again and again, and so beside each number of loops. The first number
// of threads is what the others are compared with. Throws RunError if a pile does not rest, or in another state.
std::vector<BusyRun> run_busy(const Pile& pile, SettleJob job, const std::vector<int>& loops,
                              const std::vector<int>& threads, int repetitions);

// A line of names and one for each run. ratio: of the median, against the first number of threads beside as many loops.
std::string busy_csv(const SettleJob& job, const std::vector<BusyRun>& runs);

}  // namespace rubble
