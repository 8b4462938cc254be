#include "bench/busy_run.h"

#include <gtest/gtest.h>

#include "bench/workload_file.h"

namespace rubble {
namespace busy_run_test {

TEST(BusyRun, SettlesBesideLoopsOnEachNumberOfThreads) {
  SettleJob job;
  const std::vector<BusyRun> runs = run_busy(load_workload(RUBBLE_WORKLOADS "/w0.txt"), job, {0, 1}, {1, 2}, 2);
  ASSERT_EQ(runs.size(), 4U);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].loops, int(i / 2));
    EXPECT_EQ(runs[i].threads, int(1 + i % 2));
    ASSERT_EQ(runs[i].walls.size(), 2U);
    EXPECT_GT(runs[i].walls[0], 0);
    EXPECT_LE(runs[i].walls[0], runs[i].walls[1]);
  }
}

TEST(BusyRun, ComparesWithTheFirstNumberOfThreadsBesideAsManyLoops) {
  SettleJob job;
  job.work = "w9";
  const std::vector<BusyRun> runs{{0, 1, {1, 2, 4}}, {0, 2, {1, 1, 2}}, {4, 1, {4}}, {4, 2, {5}}};
  EXPECT_EQ(busy_csv(job, runs),
            "work,schedule,loops,threads,wall_median_s,wall_least_s,wall_most_s,ratio\n"
            "w9,layers,0,1,2.000,1.000,4.000,1.00\n"
            "w9,layers,0,2,1.000,1.000,2.000,0.50\n"
            "w9,layers,4,1,4.000,4.000,4.000,1.00\n"
            "w9,layers,4,2,5.000,5.000,5.000,1.25\n");
}

}  // namespace busy_run_test
}  // namespace rubble
