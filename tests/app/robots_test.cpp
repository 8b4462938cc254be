// Robots of a mission, through the program.
#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace rubble::testing {
namespace {

constexpr const char* kQuick =
    " --set camera.width=48 --set camera.height=48 --set trajectory.rate_hz=0.5 --set robot_run.duration=2"
    " --set outputs.bag=false --set outputs.rawlog=false --set outputs.simplemap=false --out ";

TEST(Robots, RunsHaveTheSameBitsOnAnyNumberOfThreadsAndAreVerified) {
  const ScratchFolder scratch;
  std::string tracks[2];
  for (int threads = 1; threads <= 2; ++threads) {
    const std::string out = scratch / std::to_string(threads);
    const Outcome run = run_rubble("run scripts/robots/controller.lua --threads " +
                                   std::to_string(threads) + kQuick + out);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    tracks[threads - 1] = read_file(out + "/robots/track.bin");
  }
  EXPECT_FALSE(tracks[0].empty());
  EXPECT_TRUE(tracks[0] == tracks[1]);
  const Outcome verified = run_rubble("verify " + (scratch / "1"));
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

TEST(Robots, AControllerThatReturnsNoNumberIsAMistakeWithItsLine) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua",
             "return rubble.mission { pile = { layers = 0 },\n"
             "  robots = { rubble.robot.rover { position = { 0, 0, 0.001 },\n"
             "    control = function() return { linear = 0 / 0 } end } } }\n");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + kQuick + (scratch / "out"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("m.lua:3: robots[1].control: linear"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace rubble::testing
