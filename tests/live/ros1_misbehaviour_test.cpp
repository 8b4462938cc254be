// Peers of ROS 1 that misbehave, on the loopback interface: the run goes on, or ends with a
// message.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "io/live/complaints.h"
#include "io/live/live_ros.h"
#include "tests/app/program.h"
#include "tests/live/background.h"

namespace rubble::testing {
namespace ros1_misbehaviour_test {

constexpr char kScripts[] = RUBBLE_PYTHON " '" RUBBLE_SOURCE_DIR "/tests/live/";
constexpr char kImageMd5[] = "060021388200f6f0f447d0fcd9c64743";  // of sensor_msgs/Image

bool has_master() { return std::system("command -v rosmaster rosbag >/dev/null") == 0; }

class Misbehaviour : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(scratch_ / "tiny.lua", kTinyMission);
    port_ = free_port();
    uri_ = "http://127.0.0.1:" + std::to_string(port_);
    environment_ = "exec env ROS_MASTER_URI=" + uri_ +
                   " ROS_IP=127.0.0.1 PYTHONUNBUFFERED=1 ROS_LOG_DIR='" + (scratch_ / "log") + "' ";
  }

  std::unique_ptr<Background> start(const std::string& command, const std::string& output) const {
    return std::make_unique<Background>(environment_ + command, scratch_ / output);
  }
  std::unique_ptr<Background> start_script(const std::string& call,
                                           const std::string& output) const {
    return start(kScripts + call, output);
  }
  // With a word that it prints when it is ready.
  static void expect_word(const Background& program, const char* word) {
    EXPECT_TRUE(eventually(30, [&] { return program.output().find(word) != std::string::npos; }))
        << program.output();
  }
  std::unique_ptr<Background> start_bad_master(const std::string& mode) const {
    auto master = start_script(
        "bad_master.py' " + mode + " " + std::to_string(port_) + " '" + (scratch_ / "stall") + "'",
        "master.txt");
    expect_word(*master, "ready");
    return master;
  }
  std::unique_ptr<Background> start_master() const {
    auto master = start("rosmaster --core -p " + std::to_string(port_), "master.txt");
    const std::string ask =
        "exec env ROS_MASTER_URI=" + uri_ + " timeout 5 rostopic list >/dev/null 2>&1";
    EXPECT_TRUE(eventually(30, [&] { return std::system(ask.c_str()) == 0; })) << master->output();
    return master;
  }
  std::string rubble(const std::string& options) const {
    return "'" RUBBLE_PROGRAM "' run '" + (scratch_ / "tiny.lua") + "' --out '" +
           (scratch_ / "out") + "' --force --ros1 --ros-master " + uri_ + " " + options;
  }

  ScratchFolder scratch_;
  int port_ = 0;
  std::string uri_, environment_;
};

class LiveRos1BadMaster : public Misbehaviour, public ::testing::WithParamInterface<const char*> {};

TEST_P(LiveRos1BadMaster, IsNoMasterBeforeAnythingIsMade) {
  const auto master = start_bad_master(GetParam());
  const auto run = start(rubble("--rate fast"), "run.txt");
  EXPECT_EQ(run->wait(20), 2) << run->output();
  EXPECT_NE(run->output().find("no ROS master answers at " + uri_), std::string::npos)
      << run->output();
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "out"));
}

INSTANTIATE_TEST_SUITE_P(All, LiveRos1BadMaster,
                         ::testing::Values("garbage", "closes", "stalls", "nested", "wrong",
                                           "endless"));

using LiveRos1Misbehaviour = Misbehaviour;

// It is there, and what it says has other types than the Master API states.
TEST_F(LiveRos1Misbehaviour, AMasterThatAnswersInNumbersEndsTheRunWithAMessage) {
  const auto master = start_bad_master("numbers");
  const auto run = start(rubble("--rate fast"), "run.txt");
  EXPECT_EQ(run->wait(30), 2) << run->output();
  EXPECT_NE(run->output().find("the ROS master at " + uri_ + " gives answers of no ROS master"),
            std::string::npos)
      << run->output();
}

// A process that is stopped, say, or a machine that is unplugged.
TEST_F(LiveRos1Misbehaviour, AMasterThatStallsMeanwhileHoldsNothingUp) {
  const auto master = start_bad_master("stalls-later");
  const auto run =
      start(rubble("--set 'trajectory.waypoints[2].t=4' --set outputs.bag=false"), "run.txt");
  ASSERT_TRUE(eventually(30, [&] { return run->output().find("render") != std::string::npos; }));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  write_file(scratch_ / "stall", "");
  EXPECT_EQ(run->wait(60), 0) << run->output();
  EXPECT_NE(run->output().find("is gone"), std::string::npos) << run->output();
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "out/manifest.json"));
}

// The port for such requests listens on all interfaces.
TEST_F(LiveRos1Misbehaviour, ARequestOfTooManyLevelsIsNotParsed) {
  const auto master = start_bad_master("attacks");
  const auto run = start(rubble("--rate fast"), "run.txt");
  EXPECT_EQ(run->wait(60), 0) << run->output();
  EXPECT_NE(master->output().find("attacked"), std::string::npos);
}

TEST_F(LiveRos1Misbehaviour, ASubscriberThatNeverReadsTakesNothingFromTheOthers) {
  if (!has_master()) GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const auto master = start_master();
  const auto deaf = start_script(
      "deaf_subscriber.py' " + uri_ + " /camera/rgb/image_raw sensor_msgs/Image " + kImageMd5,
      "deaf.txt");
  const auto record =
      start("rosbag record --all --exclude /rosout --quiet -O '" + (scratch_ / "live.bag") + "'",
            "record.txt");
  // 60 pictures of 0.9 MB, twice what is kept for a slow one. Who records all is waited for.
  const auto run = start(rubble("--wait-for-subscribers 30 --set 'trajectory.waypoints[2].t=6' "
                                "--set camera.width=640 --set camera.height=480"),
                         "run.txt");
  expect_word(*deaf, "deaf");
  EXPECT_EQ(run->wait(90), 0) << run->output();
  record->signal(SIGINT);
  ASSERT_TRUE(eventually(20, [&] { return std::filesystem::exists(scratch_ / "live.bag"); }))
      << record->output();
  EXPECT_EQ(std::system((kScripts + std::string("compare_bags.py' '") +
                         (scratch_ / "out/mission.bag") + "' '" + (scratch_ / "live.bag") + "'")
                            .c_str()),
            0);
}

// In this process, as a drive does it.
TEST(LiveRos1Flood, OfBadCommandsIsLeftOutAndTheNextGoodOneHeard) {
  if (!has_master()) GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const ScratchFolder scratch;
  const std::string port = std::to_string(free_port()), uri = "http://127.0.0.1:" + port;
  const std::string environment = "exec env ROS_MASTER_URI=" + uri +
                                  " ROS_IP=127.0.0.1 ROS_LOG_DIR='" + (scratch / "log") + "' ";
  Background master(environment + "rosmaster --core -p " + port, scratch / "master.txt");
  Ros1Options options;
  options.master = uri;
  options.rate = 0;
  std::vector<std::string> notices;
  options.notice = [&](const std::string& line) { notices.push_back(line); };
  ASSERT_TRUE(eventually(30, [&] {
    try {
      check_ros1(options);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  })) << master.output();
  const std::unique_ptr<DriveStream> drive = make_ros1_drive(options);
  const std::uint32_t clock = drive->add("/clock", ros::kClock, false);
  Background flood(environment + kScripts + "flood_commands.py' 4000", scratch / "flood.txt");
  std::size_t heard = 0, most = 0;
  std::int64_t stamp = 0;
  const bool good = eventually(60, [&] {
    ++stamp;
    drive->write(clock, stamp, ros::clock(drive->version(), stamp));
    const DriveCommands commands = drive->take();
    most = std::max({most, commands.twists.size(), commands.joys.size()});
    heard += commands.twists.size();
    for (const TwistCommand& each : commands.twists) EXPECT_TRUE(std::isfinite(each.linear.x));
    for (const JoyCommand& each : commands.joys)
      for (const float axis : each.axes) EXPECT_TRUE(std::isfinite(axis));
    return !commands.twists.empty() && commands.twists.back().linear.x == 0.125;
  });
  EXPECT_TRUE(good) << flood.output();
  EXPECT_GT(heard, 1u);   // the huge ones, which the camera's limits bound
  EXPECT_LE(most, 100u);  // however many come between two steps
  EXPECT_GE(notices.size(), 2u);
  EXPECT_LE(notices.size(), 12u);  // not one for each
  drive->finish();
}

TEST(Complaints, AreMadeEverMoreSeldom) {
  std::vector<std::string> lines;
  Complaints complaints([&](const std::string& line) { lines.push_back(line); });
  for (int i = 0; i < 1000; ++i) complaints.note("/joy", "bad");
  complaints.note("/cmd_vel", "bad");
  EXPECT_EQ(lines,
            (std::vector<std::string>{"/joy: bad", "/joy: bad, 10 times", "/joy: bad, 100 times",
                                      "/joy: bad, 1000 times", "/cmd_vel: bad"}));
}

}  // namespace ros1_misbehaviour_test
}  // namespace rubble::testing
