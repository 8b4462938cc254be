#include "bench/sweep_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bench/workload_file.h"

namespace rubble {
namespace sweep_run_test {

TEST(SweepRun, SaysWhatMoreThreadsGainWithoutThem) {
  SettleJob job;
  job.work = "w0";
  job.options.threads = 1;
  const SweepRun run = run_sweeps(load_workload(RUBBLE_WORKLOADS "/w0.txt"), job, {1, 4});
  EXPECT_TRUE(run.settled);
  ASSERT_EQ(run.figures.size(), 2U);
  const SweepFigures &one = run.figures[0], &four = run.figures[1];
  EXPECT_EQ(one.threads, 1);
  EXPECT_EQ(four.threads, 4);
  EXPECT_GT(one.contacts, 100);
  EXPECT_EQ(four.contacts, one.contacts);
  EXPECT_EQ(one.waits, 0);
  EXPECT_GT(four.waits, 0);
  EXPECT_EQ(one.time, one.work);  // one thread never waits
  EXPECT_EQ(four.longest, one.longest);
  EXPECT_EQ(four.chain, one.chain);
  EXPECT_GE(four.time, four.longest);
  EXPECT_GE(4 * four.time, four.work);
}

TEST(SweepRun, LinesHaveAFigureForEveryColumn) {
  SweepRun run;
  run.work = "w9";
  SweepFigures f;
  f.contacts = 1000, f.batches = 75, f.chain = 210, f.work = 5000, f.longest = 1600, f.time = 5000;
  run.figures.push_back(f);
  f.threads = 2, f.waits = 330, f.work = 6000, f.time = 4000;
  run.figures.push_back(f);
  EXPECT_EQ(sweep_csv(run),
            "work,schedule,threads,contacts,batches,chain,work_rows,longest_rows,time_rows,waits,idle_percent,gain\n"
            "w9,layers,1,100,7.5,21.0,500,160,500,0,0.0,1.00\n"
            "w9,layers,2,100,7.5,21.0,600,160,400,33,25.0,1.25\n");
}

}  // namespace sweep_run_test
}  // namespace rubble
