#include "bench/hold_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/workload_file.h"

namespace rubble {
namespace hold_run_test {

TEST(HoldRun, KeepsEveryPieceAwakeAndGivesTheSameBitsForAnyThreads) {
  const Pile pile = load_workload(RUBBLE_WORKLOADS "/w0.txt");
  SettleJob job;
  job.work = "w0";
  job.options.threads = 1;
  const std::vector<HoldRun> runs = run_hold(pile, job, {1, 2});
  ASSERT_EQ(runs.size(), 2U);
  for (const HoldRun& run : runs) {
    EXPECT_TRUE(run.settled);
    EXPECT_EQ(run.pieces, 100);
    EXPECT_EQ(run.awake_body_steps, 100 * kHoldSteps);  // w0 loses none
    EXPECT_GT(run.wall, 0);
    EXPECT_GT(run.wall_median, 0);
    EXPECT_GT(run.cpu, 0);
    EXPECT_GT(run.peak_rss, 1);
    EXPECT_EQ(run.state_hash, runs[0].state_hash);
  }
  EXPECT_EQ(runs[0].threads, 1);
  EXPECT_EQ(runs[1].threads, 2);
}

TEST(HoldRun, LineHasAFigureForEveryColumn) {
  HoldRun run;
  run.work = "w9";
  run.threads = 2;
  run.pieces = 10;
  run.settled = true;
  run.awake_body_steps = 1200;
  run.wall = 1.5, run.cpu = 2.5, run.wall_median = 1.25;
  run.peak_rss = 40;
  const std::string header = hold_csv_header(), line = hold_csv_line(run);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','),
            std::count(line.begin(), line.end(), ','));
  EXPECT_EQ(line, "w9,layers,2,10,1,120,1200,1.5000,2.5000,1.2500,150.0000,40.0,0000000000000000");
}

}  // namespace hold_run_test
}  // namespace rubble
