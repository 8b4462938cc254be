#include "bench/free_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/workload_file.h"

namespace rubble {
namespace free_run_test {

// A cube of 1 m, 10 cm above one that lies on a terrain of 2 m.
const char* const kTwo =
    "shapes 1\nshape cube 8\n"
    "-0.5 -0.5 -0.5\n0.5 -0.5 -0.5\n-0.5 0.5 -0.5\n0.5 0.5 -0.5\n-0.5 -0.5 0.5\n0.5 -0.5 0.5\n-0.5 0.5 0.5\n0.5 0.5 0.5\n"
    "terrain 2 2 20\n2 2 2 2\n"
    "layer 1\n0 1 0 0 2.502 1 0 0 0\nlayer 1\n0 1 0 0 3.602 1 0 0 0\n";

TEST(FreeRun, StepsAllPiecesFromTheStartWithTheSameBitsForAnyThreads) {
  const Pile pile = parse_workload(kTwo, "two.txt");
  SettleJob job;
  job.work = "two";
  const std::vector<FreeRun> runs = run_free(pile, job, 120, true, {1, 2});
  ASSERT_EQ(runs.size(), 2U);
  for (const FreeRun& run : runs) {
    EXPECT_EQ(run.pieces, 2);
    EXPECT_EQ(run.steps, 120);
    EXPECT_LT(run.awake_body_steps, 2 * 120);  // they have fallen asleep
    EXPECT_GT(run.awake_body_steps, 2 * 10);
    EXPECT_LT(run.fastest_piece, 0.01);
    EXPECT_EQ(run.overlaps.touching_pairs, 1);
    EXPECT_EQ(run.state_hash, runs[0].state_hash);
  }
  EXPECT_EQ(run_free(pile, job, 120, false, {1}).front().awake_body_steps, 2 * 120);
}

TEST(FreeRun, LineHasAFigureForEveryColumn) {
  FreeRun run;
  run.work = "w9";
  run.threads = 2, run.pieces = 10, run.steps = 100;
  run.awake_body_steps = 1000;
  run.wall = 1.5, run.cpu = 2.5, run.slowest = 9.25;
  const std::string names = free_csv_header(), line = free_csv_line(run);
  EXPECT_EQ(std::count(names.begin(), names.end(), ','), std::count(line.begin(), line.end(), ','));
  EXPECT_EQ(line.substr(0, 62), "w9,2,10,100,1,1000,1.5000,2.5000,9.2500,150.0000,0.0000,0,0,0.");
}

}  // namespace free_run_test
}  // namespace rubble
