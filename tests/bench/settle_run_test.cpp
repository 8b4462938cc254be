#include "bench/settle_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/workload_file.h"

namespace rubble {
namespace settle_run_test {

SettleJob make_job(int threads) {
  SettleJob job;
  job.work = "w0";
  job.options.threads = threads;
  return job;
}

// The smoke test of the standard work, with the limits that a settled pile must keep.
TEST(SettleRun, BringsTheSmokeTestToACheckedRest) {
  const SettleRun run = run_settling(load_workload(RUBBLE_WORKLOADS "/w0.txt"), make_job(1));
  EXPECT_TRUE(run.state.settled);
  EXPECT_EQ(run.state.pieces.size(), 100U);
  EXPECT_EQ(run.state.lost, 0);
  EXPECT_GT(run.overlaps.touching_pairs, 5);
  EXPECT_EQ(run.overlaps.count_deeper(0.005), 0) << run.overlaps.max_depth();
  EXPECT_LT(run.overlaps.ground_max, 0.005);
  EXPECT_LT(run.overlaps.largest_disagreement(), 0.001);
  EXPECT_LT(percentile(run.drift, 50), 0.001);
  EXPECT_GT(run.cpu, 0);
  EXPECT_GT(run.peak_rss, 1);
}

TEST(SettleRun, DoesNotDependOnThreadsButOnOrientations) {
  Pile pile = load_workload(RUBBLE_WORKLOADS "/w0.txt");
  const std::uint64_t one = run_settling(pile, make_job(1)).state.state_hash();
  EXPECT_EQ(run_settling(pile, make_job(2)).state.state_hash(), one);
  turn_pieces(pile, 1);
  EXPECT_NE(run_settling(pile, make_job(1)).state.state_hash(), one);
}

TEST(SettleRun, AddsUpItsLayers) {
  SettleJob job = make_job(1);
  job.judge = false;
  const SettleRun run = run_settling(load_workload(RUBBLE_WORKLOADS "/w0.txt"), job);
  ASSERT_GE(run.layers.size(), 2U);
  EXPECT_EQ(run.layers.front().layer, 1);
  EXPECT_TRUE(run.layers.back().verifying);
  EXPECT_EQ(run.layers.back().pieces, 100);
  long steps = 0;
  for (const LayerCost& cost : run.layers) {
    steps += cost.steps;
    EXPECT_GT(cost.awake, 0);
    EXPECT_LE(cost.awake, cost.pieces * cost.steps);
  }
  EXPECT_EQ(steps, run.state.steps);
  const std::string csv = layer_csv(run.layers);
  EXPECT_EQ(std::size_t(std::count(csv.begin(), csv.end(), '\n')), run.layers.size() + 1);
}

TEST(EjectionWatch, SeesFastPiecesSidewaysAndUpButNotFalling) {
  Pile pile = load_workload(RUBBLE_WORKLOADS "/w0.txt");
  WorldOptions options;
  options.gravity = 0;
  const Vec3 velocities[] = {{0, 0, -12}, {5.5, 5.5, 0}, {0, 0, 7.9}, {5.7, 5.7, 0}, {0, 0, 8.1}};
  std::vector<NewPiece> pieces;
  for (const Vec3& v : velocities) {
    NewPiece piece;
    piece.placement.world_from_body.translation = {5.0 * double(pieces.size()), 0, 20};
    piece.linear_velocity = v;
    pieces.push_back(piece);
  }
  World world(pile.types, options);
  world.add(pieces);
  EjectionWatch watch(world);
  for (int i = 0; i < 5; ++i) {
    world.step();
    watch.look();
  }
  ASSERT_EQ(watch.ejected().size(), 2U);
  EXPECT_EQ(watch.ejected()[0].piece, 3);
  EXPECT_EQ(watch.ejected()[1].piece, 4);
  EXPECT_EQ(watch.ejected()[0].step, 1);
}

}  // namespace settle_run_test
}  // namespace rubble
