// `rubble drive --ros1`, driven by programs of ROS and heard by rosbag.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/live/background.h"
#include "tests/live/driven.h"

namespace rubble::testing {
namespace ros1_drive_test {

bool has_ros1() { return std::system("command -v rosmaster rosbag Xvfb >/dev/null") == 0; }

// Starts a master of its own.
std::string with_a_master() {
  const std::string port = std::to_string(free_port());
  return "export ROS_MASTER_URI=http://127.0.0.1:" + port + R"(
export ROS_IP=127.0.0.1 ROS_LOG_DIR=$d/log PYTHONUNBUFFERED=1
rosmaster --core -p )" + port + R"( >$d/master 2>&1 & master=$!
for i in $(seq 100); do timeout 5 rostopic list >/dev/null 2>&1 && break; sleep 0.1; done)";
}

// Drives by drive_by_topics.py while rosbag records.
std::string by_topics(const std::string& heard, const std::string& what = "") {
  return "\nrosbag record --quiet -O $d/live.bag " + heard + R"( >$d/record 2>&1 & record=$!
')" RUBBLE_PYTHON "' '" RUBBLE_SOURCE_DIR R"(/tests/live/drive_by_topics.py' $d/published )" + what + R"( || exit 1
kill -INT $record; wait $record)";
}

TEST(LiveRos1Drive, WhatTopicsDriveRunsAgainByteForByte) {
  if (!has_ros1()) GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const ScratchFolder scratch;
  drive_in_a_window(scratch, with_a_master(), "--ros1",
                    by_topics("/tf /camera/rgb/image_raw /camera/depth_registered/image_raw"));
  if (!HasFatalFailure()) expect_the_drive_runs_again(scratch, true);
}

TEST(LiveRos1Drive, ARobotGoesAsTopicsAskAndRunsAgainWithTheSameBits) {
  if (!has_ros1()) GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const ScratchFolder scratch;
  write_robot_mission(scratch);
  drive_in_a_window(scratch, with_a_master(), "--ros1", by_topics("/odom /joint_states /contacts /imu /scan", "robot"), "$d/robot.lua");
  if (!HasFatalFailure()) expect_the_robot_runs_again(scratch, true);
}

// A program of its own drives the robot of that mission and says that it arrived; the run of what was driven, scratch/leg,
// has the same bits. result: what it said.
void drive_by_program(const ScratchFolder& scratch, const std::string& command, const std::string& mission,
                      const std::string& run_options, nlohmann::json& result) {
  drive_in_a_window(scratch, with_a_master(), "--ros1",
                    "\n" + command + " >$d/result.json 2>$d/node || touch $d/failed\nkill -TERM $drive", mission, 500);
  if (::testing::Test::HasFatalFailure()) return;
  const std::string text = read_file(scratch / "result.json");
  std::printf("%s", text.c_str());
  result = nlohmann::json::parse(text);
  EXPECT_EQ(result["result"], "arrived") << text << read_file(scratch / "node") << read_file(scratch / "stderr");
  EXPECT_LT(result["real_time_factor"].get<double>(), 1.05) << "the drive keeps to real time, or is slower";
  const Outcome run = run_rubble("run " + (scratch / "out/leg_001.lua") + " --quiet --set camera.width=32 --set " +
                                 "camera.height=24 " + run_options + " --out " + (scratch / "leg"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(read_file(scratch / "out/leg_001.track") == read_file(scratch / "leg/robots/track.bin"));
}

// A program that knows the robot by its topics alone takes it through a lean-to, in real time; the run of what was
// driven ends at the same place, behind the lean-to.
TEST(NightlyLiveRos1Drive, AProgramOfItsOwnDrivesThroughALeanTo) {
  if (!has_ros1()) GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const ScratchFolder scratch;
  nlohmann::json result;
  drive_by_program(scratch, "'" RUBBLE_PYTHON "' '" RUBBLE_SOURCE_DIR "/examples/ros1/follow_the_gap.py' 6.5",
                   "examples/ros1/lean_to.lua", "--set trajectory.rate_hz=0.05 --set lidars.scan.rate_hz=1",
                   result);
  if (HasFatalFailure()) return;
  const std::string truth = read_file(scratch / "leg/robots/rover.txt");
  std::istringstream last(truth.substr(truth.rfind('\n', truth.size() - 2) + 1));
  double time = 0, x = 0, y = 0;
  last >> time >> x >> y;
  std::printf("truly at %.2f, %.2f m\n", x, y);
  EXPECT_GT(y, 2.2) << "the lean-to ends at 2 m";
}

// MRPT's navigator takes a crawler through a lean-to by odometry that slips and a LiDAR; the run of what was driven ends
// before the goal, behind the lean-to.
TEST(NightlyLiveRos1Drive, MrptsNavigatorDrivesACrawlerThroughALeanTo) {
  if (!has_ros1()) GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const ScratchFolder scratch;
  nlohmann::json result;
  drive_by_program(scratch, "'" RUBBLE_NAVIGATOR "' --goal 8.5 0", "examples/ros1/crawler_lean_to.lua",
                   "--set trajectory.rate_hz=1 --set lidars.points.rate_hz=1", result);
  if (HasFatalFailure()) return;
  const std::string judge = "'" RUBBLE_PYTHON "' '" RUBBLE_SOURCE_DIR "/bench/ros1_navigate/judge.py' '" + (scratch / "leg") +
                            "' >'" + (scratch / "truth.json") + "'";
  ASSERT_EQ(std::system(judge.c_str()), 0);
  const auto truth = nlohmann::json::parse(read_file(scratch / "truth.json"));
  std::printf("%s\n", truth.dump().c_str());
  const double ahead = truth["ahead_m"], aside = truth["aside_m"];
  EXPECT_LT(std::hypot(ahead - 8.5, aside), 0.7) << "within 0.3 m of the goal, and what the pose may be wrong by";
  EXPECT_LT(std::hypot(ahead - result["x_m"].get<double>(), aside - result["y_m"].get<double>()), 0.4);
  EXPECT_LT(result["left_m"].get<double>(), 0.35);
}

// The bench drives a pile of `rubble bench navigate` over topics, judges it, and writes its table; a second time it has
// nothing to drive any more.
TEST(NightlyLiveRos1Drive, TheBenchDrivesAMissionOverTopicsAndTablesIt) {
  if (!has_ros1()) GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const ScratchFolder scratch;
  const std::string page = scratch / "page.md";
  write_file(page, "before\n<!-- begin ros1_navigate -->\n<!-- end ros1_navigate -->\n");
  const std::string bench = "cd '" RUBBLE_SOURCE_DIR "' && timeout 600 bench/ros1_navigate/run --seeds 1 --build \"$(dirname '" RUBBLE_PROGRAM
                            "')\" --out '" + (scratch / "out") + "' --document '" + page + "' >'" + (scratch / "said") + "' 2>&1";
  ASSERT_EQ(std::system(bench.c_str()), 0) << read_file(scratch / "said");
  const auto result = nlohmann::json::parse(read_file(scratch / "out/ompl/1.json"), nullptr, false);
  ASSERT_TRUE(result.is_object());
  EXPECT_EQ(result["node"]["result"], "arrived") << result;
  EXPECT_LT(result["goal_m"], 0.7);
  EXPECT_LT(result["truth"]["worst_m"], 0.4);
  EXPECT_GT(result["truth"]["way_m"], 3);
  const std::string table = read_file(page);
  EXPECT_NE(table.find("| missions | 1 |\n| arrived | 1.00 (95 %: 0.21 to 1.00) |"), std::string::npos) << table;
  ASSERT_EQ(std::system(bench.c_str()), 0) << read_file(scratch / "said");
  EXPECT_EQ(read_file(page), table);
}

}  // namespace ros1_drive_test
}  // namespace rubble::testing
