// ros1_navigator among programs of ROS: a robot of rospy that it drives, and all that may be missing or wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/live/ros1_master.h"

namespace rubble::testing {
namespace ros1_navigator_test {

class LiveRos1Navigator : public WithRos1Master {
 protected:
  std::unique_ptr<Background> start_robot(const std::string& mode) const {
    auto robot = start("'" RUBBLE_PYTHON "' '" RUBBLE_SOURCE_DIR "/tests/live/fake_robot.py' " + mode, "robot.txt");
    EXPECT_TRUE(eventually(30, [&] { return robot->output().find("ready") != std::string::npos; })) << robot->output();
    return robot;
  }
  // It prints its report and its complaints into one file.
  std::unique_ptr<Background> start_navigator(const std::string& options) const {
    return start("'" RUBBLE_NAVIGATOR "' --turn-share 1 " + options, "navigator.txt");
  }
  static nlohmann::json report_of(const Background& navigator) {
    const std::string text = navigator.output();
    const std::size_t from = text.find('{'), to = text.rfind('}');
    if (from == std::string::npos || to == std::string::npos) return {{"result", text}};
    return nlohmann::json::parse(text.substr(from, to - from + 1));
  }
  static void expect_to_say(const Background& program, const std::string& what) {
    EXPECT_NE(program.output().find(what), std::string::npos) << program.output();
  }
};

TEST_F(LiveRos1Navigator, WithoutAMasterItSaysHowToStartOne) {
  const auto navigator = start_navigator("--goal 1 0");
  EXPECT_EQ(navigator->wait(20), 2) << navigator->output();
  expect_to_say(*navigator, "no ROS master answers at " + uri_);
  expect_to_say(*navigator, "roscore");
}

TEST_F(LiveRos1Navigator, NamesMistakesOfItsOptions) {
  EXPECT_EQ(start_navigator("")->wait(20), 2) << "it has no goal";
  const auto far = start_navigator("--goal 1000 0");
  EXPECT_EQ(far->wait(20), 2);
  expect_to_say(*far, "--goal: too far");
  const auto second = start_navigator("--goal 1 0 --goal 3 -60");
  EXPECT_EQ(second->wait(20), 2);
  expect_to_say(*second, "3.000000 -60.000000");
  EXPECT_EQ(start_navigator("--goal 1 0 --goal 3")->wait(20), 2) << "half of a place";
  EXPECT_EQ(start_navigator("--goal 1 0 --robot snake")->wait(20), 2);
}

TEST_F(LiveRos1Navigator, TopicsThatNeverComeAreNamed) {
  const auto master = start_master();
  const auto silent = start_navigator("--goal 1 0 --wait 2");
  EXPECT_EQ(silent->wait(30), 1) << silent->output();
  EXPECT_EQ(report_of(*silent)["result"], "no data");
  expect_to_say(*silent, "no odometry came");
  const auto robot = start_robot("open");
  const auto elsewhere = start_navigator("--goal 1 0 --wait 3 --topic /lidar");
  EXPECT_EQ(elsewhere->wait(30), 1) << elsewhere->output();
  expect_to_say(*elsewhere, "no cloud or scan");
  const auto frames = start_navigator("--goal 1 0 --wait 3 --pose tf --base-frame nothing");
  EXPECT_EQ(frames->wait(30), 1) << frames->output();
  expect_to_say(*frames, "no transform from odom to nothing");
}

// Half of the points of every cloud are NaN.
TEST_F(LiveRos1Navigator, DrivesARobotOfRospy) {
  const auto master = start_master();
  const auto robot = start_robot("nan");
  const auto navigator = start_navigator("--goal 1.5 0.4 --log '" + (scratch_ / "log.csv") + "'");
  EXPECT_EQ(navigator->wait(60), 0) << navigator->output();
  const nlohmann::json report = report_of(*navigator);
  EXPECT_EQ(report["result"], "arrived") << report;
  EXPECT_GT(report["points_left_out"].get<int>(), 1000);
  ASSERT_TRUE(eventually(10, [&] {
    const std::string said = robot->output();
    return said.find("driven by 0.000 0.000", said.rfind("at ", said.size() - 2)) != std::string::npos;
  })) << "it is told to stop";
  const std::string said = robot->output();
  std::istringstream last(said.substr(said.rfind("at ") + 3));
  double x = 0, y = 0;
  last >> x >> y;
  EXPECT_LT(std::hypot(x - 1.5, y - 0.4), 0.45) << "it stands at " << x << ", " << y;
  const std::string log = read_file(scratch_ / "log.csv");
  EXPECT_GT(std::count(log.begin(), log.end(), '\n'), 10);
}

TEST_F(LiveRos1Navigator, CloudsOfNoPointsAreNoClouds) {
  const auto master = start_master();
  const auto robot = start_robot("blind");
  const auto navigator = start_navigator("--goal 1.5 0 --wait 3");
  EXPECT_EQ(navigator->wait(30), 1) << navigator->output();
  expect_to_say(*navigator, "without one finite point");
}

TEST_F(LiveRos1Navigator, EndsWhereTimeBeginsAnew) {
  const auto master = start_master();
  const auto robot = start_robot("again");
  const auto navigator = start_navigator("--goal 3 0");
  EXPECT_EQ(navigator->wait(30), 1) << navigator->output();
  EXPECT_EQ(report_of(*navigator)["result"], "restarted") << navigator->output();
}

TEST_F(LiveRos1Navigator, EndsWhereItsRobotIsGone) {
  const auto master = start_master();
  auto robot = start_robot("open");
  const auto navigator = start_navigator("--goal 3 0");
  ASSERT_TRUE(eventually(20, [&] { return robot->output().find("driven by 0.3") != std::string::npos; })) << navigator->output();
  robot.reset();
  EXPECT_EQ(navigator->wait(30), 1) << navigator->output();
  expect_to_say(*navigator, "do not come any more");
}

TEST_F(LiveRos1Navigator, ASignalStopsTheRobotAndStillReports) {
  const auto master = start_master();
  const auto robot = start_robot("open");
  const auto navigator = start_navigator("--goal 3 0");
  ASSERT_TRUE(eventually(20, [&] { return robot->output().find("driven by 0.3") != std::string::npos; })) << navigator->output();
  navigator->signal(SIGTERM);
  EXPECT_EQ(navigator->wait(20), 4) << navigator->output();
  EXPECT_EQ(report_of(*navigator)["result"], "stopped");
  EXPECT_TRUE(eventually(5, [&] {
    const std::string said = robot->output();
    return said.find("driven by 0.000 0.000", said.rfind("at ", said.size() - 2)) != std::string::npos;
  })) << robot->output();
}

}  // namespace ros1_navigator_test
}  // namespace rubble::testing
