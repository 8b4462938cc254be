// A robot in a building that an earthquake brought down, through the whole program: driven, recorded, verified, stopped,
// resumed and made again.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace ruin_drive_test {

namespace fs = std::filesystem;

// One bay of a frame whose slab comes down onto the ground. The crawler drives against the ruin, in smoke.
constexpr const char* kMission = R"(return rubble.mission {
  seed = 4,
  pile = rubble.building {
    storeys = 1, bays_x = 1, bays_y = 1, span_x = 4, span_y = 4, column = 0.25, piece = 2, infill = "none", continuity = 0.3,
    cause = { shake = 8, shake_seconds = 2, weak_storey = 0, weakness = 0.03 },
  },
  settle = { final_time_limit = 30 },
  air = { fog_density = 0.1, fog_noise = 0.8 },
  robots = { rubble.robot.crawler { name = "tank", position = { -3.6, 0, 0.001 }, odometry_noise = 0.001,
                                    drive = { { t = 0, linear = 0.6, flippers_deg = { 40, 40, 0, 0 } } } } },
  robot_run = { duration = 2.5 },
  lidars = { scan = { model = "utm30lx", rate_hz = 10, ride = { robot = "tank" }, position = { 0.2, 0, 0.3 } } },
  imu = { on = true },
  camera = { width = 32, height = 24, quality = "draft" },
  trajectory = { rate_hz = 2, ride = { robot = "tank", position = { 0.3, 0, 0.3 } } },
  outputs = { mcap = true, simplemap = false, preview = false },
})";

class RuinDrive : public ::testing::Test {
 protected:
  void SetUp() override { write_file(folder_ / "m.lua", kMission); }
  std::string run(const std::string& name, const std::string& more = "") const {
    return "run " + (folder_ / "m.lua") + " --quiet --out " + (folder_ / name) + " " + more;
  }
  ScratchFolder folder_;
};

void expect_equal_files(const std::string& a, const std::string& b) {
  EXPECT_EQ(reproducible(a), reproducible(b));
  for (const auto& [name, hash] : read_outputs(a)) EXPECT_EQ(read_file(a + "/" + name), read_file(b + "/" + name)) << name;
}

TEST_F(RuinDrive, IsTheSameVerifiedMadeAgainAndResumed) {
  const std::string first = folder_ / "a";
  const Outcome driven = run_rubble(run("a", "--threads 1"));
  ASSERT_EQ(driven.exit_code, 0) << driven.err;
  const auto metrics = read_manifest(first).at("metrics");
  EXPECT_LT(metrics.at("pile_height_m").get<double>(), 2) << "it fell";
  EXPECT_GT(metrics.at("robot_distance_m").get<double>(), 0.5);
  EXPECT_EQ(metrics.at("robots_lost").get<double>(), 0);
  const std::string recorded = read_file(first + "/mission.mcap");
  for (const char* topic : {"/camera/rgb/image_raw", "/camera/depth_registered/", "/scan", "/imu", "/odom"})
    EXPECT_NE(recorded.find(topic), std::string::npos) << topic << " was not recorded";
  EXPECT_EQ(run_rubble("verify --quiet --threads 2 " + first).exit_code, 0);
  const Outcome remake = run_rubble("remake --quiet " + first + "/manifest.json --out " + (folder_ / "b"));
  ASSERT_EQ(remake.exit_code, 0) << remake.err;
  expect_equal_files(first, folder_ / "b");
  // Stopped when the pile lies there: the robot starts from pile.bin.
  const std::string part = folder_ / "part";
  const Outcome stopped = run_rubble_and_signal(run("part"), [&] { return fs::exists(part + "/pile.bin"); }, SIGTERM);
  if (stopped.exit_code != 0) {
    const Outcome resumed = run_rubble("resume --quiet " + part);
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  }
  expect_equal_files(first, part);
}

// Nothing of the ruin moves by itself: pieces move where the robot pushes, and nowhere else.
TEST_F(RuinDrive, TheRuinStaysWhereNobodyPushes) {
  alter(folder_ / "m.lua", "linear = 0.6", "linear = 0");
  const Outcome still = run_rubble(run("still", "--set robot_run.duration=1 --set outputs.mcap=false"));
  ASSERT_EQ(still.exit_code, 0) << still.err;
  EXPECT_EQ(read_manifest(folder_ / "still").at("metrics").at("robot_pieces_moved").get<double>(), 0);
}

// Cameras on the rig and on a robot: the way between them is nobody's way.
TEST_F(RuinDrive, APathOfOneCarrierIsNotThatOfAnother) {
  write_file(folder_ / "m.lua", R"(return rubble.mission {
  pile = { layers = 0, placed = { { box = { 1, 1, 1 }, position = { 0, 0, 0.5 } } } },
  robots = { rubble.robot.rover { name = "scout", position = { 4, 0, 0.001 }, drive = { { t = 0, linear = 0.5 } } } },
  robot_run = { duration = 1 },
  cameras = { fixed = { width = 16, height = 16 },
              riding = { width = 16, height = 16, ride = { robot = "scout" }, position = { 0.2, 0, 0.25 } } },
  trajectory = { rate_hz = 10, waypoints = { { t = 0, position = { -1, 0, 1 }, look_at = { 0, 0, 1 } },
                                             { t = 1, position = { -1.25, 0, 1 }, look_at = { 0, 0, 1 } } } },
  outputs = { rawlog = false, simplemap = false, bag = false, stl = false, preview = false, mcap = true },
})");
  const Outcome outcome = run_rubble(run("two"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NEAR(read_manifest(folder_ / "two").at("metrics").at("path_m").get<double>(), 0.25, 1e-3) << "of the rig";
  // A camera on the robot alone.
  alter(folder_ / "m.lua", "fixed = { width = 16, height = 16 },", "");
  ASSERT_EQ(run_rubble(run("one")).exit_code, 0);
  const auto metrics = read_manifest(folder_ / "one").at("metrics");
  EXPECT_NEAR(metrics.at("path_m").get<double>(), metrics.at("robot_path_m").get<double>(), 0.06);
}

}  // namespace ruin_drive_test
}  // namespace rubble::testing
