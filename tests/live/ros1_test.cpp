// `--ros1` against ROS 1 itself: roscore, rosbag and rostopic of Debian, on the loopback interface.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "io/live/live_ros.h"
#include "tests/app/program.h"
#include "tests/live/background.h"

namespace rubble::testing {
namespace ros1_test {

constexpr char kTopics[] =
    "/clock /tf /tf_static /ground_truth/pose /camera/rgb/image_raw /camera/rgb/camera_info "
    "/camera/depth_registered/image_raw /camera/depth_registered/camera_info";

// A flight at 10 Hz, in real time, long enough for what is done meanwhile.
std::string flight_of(int seconds) {
  return "--set 'trajectory.waypoints[2].t=" + std::to_string(seconds) + "' --set outputs.bag=false";
}

class LiveRos1 : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(scratch_ / "tiny.lua", kTinyMission);
    port_ = free_port();
    uri_ = "http://127.0.0.1:" + std::to_string(port_);
    environment_ = "ROS_MASTER_URI=" + uri_ + " ROS_IP=127.0.0.1 PYTHONUNBUFFERED=1 ROS_LOG_DIR='" +
                   (scratch_ / "log") + "' ";
  }

  static bool has_roscore() { return std::system("command -v roscore rosbag rostopic >/dev/null") == 0; }

  std::string shell(const std::string& command) const { return "exec env " + environment_ + command; }

  bool succeeds(const std::string& command) const {
    return std::system((environment_ + command + " >/dev/null 2>&1").c_str()) == 0;
  }

  bool master_answers() const { return succeeds("timeout 5 rostopic list"); }

  // `rosmaster`, which roscore starts, can be killed without leaving anything behind.
  std::unique_ptr<Background> start_master(const std::string& name = "rosmaster --core") {
    auto master = std::make_unique<Background>(shell(name + " -p " + std::to_string(port_)),
                                               scratch_ / "master.txt");
    EXPECT_TRUE(eventually(30, [this] { return master_answers(); })) << master->output();
    return master;
  }

  // Without ROS_IP: that on the loopback interface all finds together is to be shown, too.
  std::string rubble(const std::string& options) const {
    return "exec env HOME='" + (scratch_ / "home") + "' '" RUBBLE_PROGRAM "' run '" +
           (scratch_ / "tiny.lua") + "' --out '" + (scratch_ / "out") + "' --force --ros1 --ros-master " +
           uri_ + " " + options;
  }

  int compare(const std::string& bag, const std::string& other) const {
    return std::system((RUBBLE_PYTHON " '" RUBBLE_SOURCE_DIR "/tests/live/compare_bags.py' '" + bag +
                        "' '" + other + "'")
                           .c_str());
  }

  ScratchFolder scratch_;
  int port_ = 0;
  std::string uri_, environment_;
};

using NightlyLiveRos1 = LiveRos1;

TEST_F(LiveRos1, WithoutAMasterSaysHowToStartOne) {
  const Outcome outcome = run_rubble("run scripts/small.lua --out '" + (scratch_ / "out") +
                                     "' --ros1 --ros-master " + uri_);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("no ROS master answers at " + uri_), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("`roscore`"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "out"));  // refused before anything is made
}

TEST_F(LiveRos1, AnAddressThatIsNoneIsRefused) {
  for (const char* uri : {"localhost:11311", "http://localhost", "http://:1", "http://localhost:99999"}) {
    const Outcome outcome = run_rubble(std::string("run scripts/small.lua --ros1 --ros-master ") + uri);
    EXPECT_EQ(outcome.exit_code, 1) << uri;
    EXPECT_NE(outcome.err.find("--ros-master"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run_rubble("run scripts/small.lua --ros-master http://localhost:1").exit_code, 1);
  EXPECT_EQ(run_rubble("run scripts/small.lua --ros1 --rate slow").exit_code, 1);
}

TEST_F(LiveRos1, TheStreamThatRosbagRecordsIsTheBag) {
  if (!has_roscore()) GTEST_SKIP() << "no roscore: see tools/packages-live.txt";
  Background core(shell("roscore -p " + std::to_string(port_)), scratch_ / "core.txt");
  ASSERT_TRUE(eventually(30, [this] { return master_answers(); })) << core.output();
  Background record(shell("rosbag record -O '" + (scratch_ / "live.bag") + "' " + kTopics),
                    scratch_ / "record.txt");
  Background run(rubble("--rate fast --wait-for-subscribers 30"), scratch_ / "run.txt");
  EXPECT_EQ(run.wait(60), 0) << run.output();
  record.signal(SIGINT);
  ASSERT_TRUE(eventually(10, [this] { return std::filesystem::exists(scratch_ / "live.bag"); }))
      << record.output();
  EXPECT_EQ(compare(scratch_ / "out/mission.bag", scratch_ / "live.bag"), 0);
  // A run of another seed is not the same.
  ASSERT_EQ(run_rubble("run '" + (scratch_ / "tiny.lua") + "' --seed 4 --out '" + (scratch_ / "4") + "'")
                .exit_code,
            0);
  EXPECT_NE(compare(scratch_ / "4/mission.bag", scratch_ / "live.bag"), 0);
}

TEST_F(NightlyLiveRos1, ToolsSeeTheStreamInRealTimeAndLateComersTheStaticTransforms) {
  const auto master = start_master();
  Background run(rubble(flight_of(15)), scratch_ / "run.txt");
  ASSERT_TRUE(eventually(30, [this] { return succeeds("timeout 2 rostopic echo -n 1 /clock"); }));
  Background frequency(shell("rostopic hz -w 20 /camera/rgb/image_raw"), scratch_ / "hz.txt");
  Background fixed(shell("rostopic echo -n 1 /tf_static"), scratch_ / "static.txt");
  Background clock(shell("rostopic echo -n 3 /clock"), scratch_ / "clock.txt");
  // Messages on the loopback interface alone; the other is roscpp's XML-RPC port (docs/how_to/live.md).
  EXPECT_EQ(listening_addresses(run.pid()),
            (std::multiset<std::string>{"00000000", "0100007F"}));
  EXPECT_EQ(fixed.wait(8), 0);
  EXPECT_NE(fixed.output().find("camera_optical_frame"), std::string::npos) << fixed.output();
  EXPECT_EQ(clock.wait(8), 0);
  ASSERT_TRUE(eventually(10, [&] { return frequency.output().find("window: 20") != std::string::npos; }))
      << frequency.output();
  const std::string text = frequency.output();
  const std::string key = "average rate: ";
  EXPECT_NEAR(std::stod(text.substr(text.rfind(key) + key.size())), 10, 0.5);
  EXPECT_EQ(run.wait(60), 0) << run.output();
}

TEST_F(NightlyLiveRos1, AMasterThatDiesAndReturnsIsToldOfTheTopicsAgain) {
  auto master = start_master();
  Background run(rubble(flight_of(30)), scratch_ / "run.txt");
  ASSERT_TRUE(eventually(30, [this] { return succeeds("timeout 2 rostopic echo -n 1 /clock"); }));
  Background early(shell("rostopic echo /clock"), scratch_ / "early.txt");
  ASSERT_TRUE(eventually(10, [&] { return !early.output().empty(); }));
  master->signal(SIGKILL);
  master.reset();
  ASSERT_TRUE(eventually(5, [&] { return run.output().find("is gone") != std::string::npos; }));
  const std::size_t before = early.output().size();
  EXPECT_TRUE(eventually(5, [&] { return early.output().size() > before; }));
  EXPECT_FALSE(master_answers());
  master = start_master();
  EXPECT_TRUE(eventually(5, [&] { return run.output().find("is back") != std::string::npos; }));
  EXPECT_TRUE(succeeds("timeout 5 rostopic echo -n 1 /camera/rgb/camera_info"));
  EXPECT_TRUE(succeeds("timeout 5 rostopic echo -n 1 /tf_static"));
  EXPECT_EQ(run.wait(60), 0) << run.output();
}

// In this process, as a drive does it, but without one.
TEST_F(NightlyLiveRos1, CommandsAreHeardAgainWhenAMasterReturns) {
  auto master = start_master();
  Ros1Options options;
  options.master = uri_;
  options.rate = 0;
  check_ros1(options);
  const std::unique_ptr<DriveStream> drive = make_ros1_drive(options);
  drive->write(drive->add("/clock", ros::kClock, false), 1, ros::clock(drive->version(), 1));
  const auto hears = [&](double speed) {
    return eventually(20, [&] {
      const DriveCommands commands = drive->take();
      return !commands.twists.empty() && commands.twists.back().linear.x == speed;
    });
  };
  const auto say = [&](const char* speed, const std::string& file) {
    return std::make_unique<Background>(
        shell("rostopic pub -r 10 /cmd_vel geometry_msgs/Twist '{linear: {x: " + std::string(speed) + "}}'"),
        scratch_ / file);
  };
  auto first = say("0.25", "first.txt");
  EXPECT_TRUE(hears(0.25)) << first->output();
  first.reset();
  EXPECT_FALSE(eventually(1, [&] { return !drive->take().twists.empty(); }));
  master->signal(SIGKILL);
  master.reset();
  master = start_master();
  const auto second = say("0.5", "second.txt");
  EXPECT_TRUE(hears(0.5)) << second->output();
  drive->finish();
}

}  // namespace ros1_test
}  // namespace rubble::testing
