// Lamps that robots of a mission bear.
#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "io/image/image_file.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace robot_lamps_test {

// By night a camera that stands beside watches a robot drive towards a block.
std::string night(const std::string& robot, const std::string& more = "") {
  return R"(return rubble.mission {
  pile = { layers = 0, placed = { { box = { 0.4, 0.8, 0.6 }, position = { 1.5, 0, 0.3 } } } },
  robots = { )" + robot + R"( },
  robot_run = { duration = 1 },
  light = { type = "sun", sky = "city_night" },
  lamp = { on = false },
  camera = { width = 64, height = 48, fov_deg = 70, exposure = { mode = "fixed", time = 0.02, iso = 800 } },
  trajectory = { rate_hz = 1, waypoints = { { t = 0, position = { 0.5, -2, 1 }, look_at = { 1, 0, 0.2 } },
                                            { t = 1, position = { 0.5, -2, 1 }, look_at = { 1, 0, 0.2 } } } },
  outputs = { bag = false, rawlog = false, simplemap = false, frames = true },
  )" + more + "}\n";
}

double brightness(const std::string& robot, const std::string& more = "") {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", night(robot, more));
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --force --out " + (scratch / "out"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  if (run.exit_code != 0) return 0;
  const RgbImage image = read_rgb_png(scratch / "out/frames/rgb/000000.png");
  return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0) / double(image.rgb.size());
}

TEST(RobotLamps, HeadlampsOfAllBundledRobotsShineForwards) {
  const struct {
    std::string model, height;
  } robots[] = {{"rover", "0.001"}, {"crawler", "0.001"}, {"snake", "0.05"}, {"vine", "0.3"}};
  for (const auto& [model, height] : robots) {
    const std::string begin = "rubble.robot." + model + " { position = { 0, 0, " + height + " }";
    const double lit = brightness(begin + ", lamps = { { intensity_cd = 300 } } }");
    const double behind = brightness(begin + ", lamps = { { intensity_cd = 300, rpy_deg = { 0, 0, 180 } } } }");
    EXPECT_GT(lit, behind + 5) << model << ": the block is before it";
  }
}

TEST(RobotLamps, MistakesNameTheLamp) {
  const struct {
    std::string robot, more, expected;
  } cases[] = {
      {"rubble.robot.rover { position = { 0, 0, 0.001 }, lamps = { {}, { link = \"mast\" } } }", "",
       "robots[1].lamps[2].link: the robot has no such link: expected one of base_link, "},
      {"rubble.robot.rover { position = { 0, 0, 0.001 }, lamps = { {}, {}, {} } }",
       "lights = { { type = \"point\", position = { 0, 0, 3 } } },", "robots: too many lamps: expected at most 3"},
      {"rubble.robot.rover { position = { 0, 0, 0.001 }, lamps = { { cone_deg = 200 } } }", "", "robots[1].lamps[1].cone_deg"}};
  for (const auto& c : cases) {
    const ScratchFolder scratch;
    write_file(scratch / "m.lua", night(c.robot, c.more));
    const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --force --out " + (scratch / "out"));
    EXPECT_EQ(run.exit_code, 1) << c.expected;
    EXPECT_NE(run.err.find(c.expected), std::string::npos) << run.err;
  }
}

}  // namespace robot_lamps_test
}  // namespace rubble::testing
