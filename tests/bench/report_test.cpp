#include "bench/report.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rubble {
namespace report_test {

SettleRun make_run() {
  SettleRun run;
  run.work = "w9";
  run.schedule = Schedule::planes;
  run.threads = 2;
  run.wall = 1.25;
  run.cpu = 2.5;
  run.peak_rss = 40;
  run.state.types = {"bar", "slab"};
  run.state.pieces.resize(2);
  run.state.pieces[1].type = 1;
  run.state.steps = 600;
  run.state.simulated = 10;
  run.state.settled = true;
  run.masses = {3, 500};
  run.overlaps.overlaps = {{0, 1, 0.0071, 0.0071}};
  run.overlaps.touching_pairs = 1;
  run.overlaps.ground_max = 0.0002;
  run.drift = {0.001, 0.002};
  run.drifted = {0, 1};
  run.ejected.push_back({0, 17, {}, {0, 0, 9}, {1, 2, 3}});
  return run;
}

TEST(Report, LineHasAFigureForEveryColumn) {
  const std::string header = csv_header(), line = csv_line(make_run());
  EXPECT_EQ(std::count(header.begin(), header.end(), ','),
            std::count(line.begin(), line.end(), ','));
  const std::string expected =
      "w9,planes,2,1.250,2.500,10.0000,600,1,1,1,0,7.100,7.100,7.100,0.200,1,0,1.0000,2.0000,40.0,";
  EXPECT_EQ(line.substr(0, expected.size()), expected);
  EXPECT_EQ(line.size(), expected.size() + 16);  // the hash
}

TEST(Report, NamesTheWorstPieces) {
  const std::string text = worst_text(make_run(), 5);
  EXPECT_NE(text.find("7.10 mm  #0 bar 3.0 kg"), std::string::npos) << text;
  EXPECT_NE(text.find("#1 slab 500.0 kg"), std::string::npos) << text;
  EXPECT_NE(text.find("step 17 at (1.00, 2.00, 3.00)"), std::string::npos) << text;
}

}  // namespace report_test
}  // namespace rubble
