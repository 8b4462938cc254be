#include "bench/busy_run.h"

#include <algorithm>
#include <cstdio>

#include "bench/report.h"
#include "kernel/base/error.h"

namespace rubble {

BusyLoops::BusyLoops(int count) {
  for (int i = 0; i < count; ++i) {
    threads_.emplace_back([this] {
      while (!stop_.load(std::memory_order_relaxed)) {
      }
    });
  }
}

BusyLoops::~BusyLoops() {
  stop_ = true;
  for (std::thread& thread : threads_) thread.join();
}

std::vector<BusyRun> run_busy(const Pile& pile, SettleJob job, const std::vector<int>& loops,
                              const std::vector<int>& threads, int repetitions) {
  job.judge = false;
  std::vector<BusyRun> runs;
  std::uint64_t hash = 0;
  for (const int beside : loops) {
    const std::size_t first = runs.size();
    for (const int t : threads) runs.push_back({beside, t, {}});
    const BusyLoops busy(beside);
    for (int repetition = 0; repetition < repetitions; ++repetition) {
      for (std::size_t i = first; i < runs.size(); ++i) {
        job.options.threads = runs[i].threads;
        const SettleRun run = run_settling(pile, job);
        if (!run.state.settled) throw RunError("the pile did not rest");
        if (hash != 0 && hash != run.state.state_hash()) throw RunError("the pile rests in another state");
        hash = run.state.state_hash();
        runs[i].walls.push_back(run.wall);
      }
    }
  }
  for (BusyRun& run : runs) std::sort(run.walls.begin(), run.walls.end());
  return runs;
}

std::string busy_csv(const SettleJob& job, const std::vector<BusyRun>& runs) {
  std::string text = "work,schedule,loops,threads,wall_median_s,wall_least_s,wall_most_s,ratio\n";
  const BusyRun* first = nullptr;
  for (const BusyRun& run : runs) {
    if (first == nullptr || first->loops != run.loops) first = &run;
    char line[256];
    std::snprintf(line, sizeof line, "%s,%s,%d,%d,%.3f,%.3f,%.3f,%.2f\n", job.work.c_str(),
                  name_of(job.options.schedule).c_str(), run.loops, run.threads, run.median(), run.walls.front(),
                  run.walls.back(), run.median() / first->median());
    text += line;
  }
  return text;
}

}  // namespace rubble
