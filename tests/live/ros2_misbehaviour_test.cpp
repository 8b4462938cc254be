// A DDS peer that floods, on the loopback interface: driving goes on.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "io/live/live_ros.h"
#include "tests/app/program.h"
#include "tests/live/background.h"

namespace rubble::testing {
namespace ros2_misbehaviour_test {

using Clock = std::chrono::steady_clock;

// unit: MiB
double memory_in_use() {
  double pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

// In this process, as a drive does it.
TEST(LiveRos2Flood, OfBadCommandsIsLeftOutAndTheNextGoodOneHeard) {
  const ScratchFolder scratch;
  Ros2Options options;
  options.domain = 101 + int(getpid()) % 100;
  options.interface = "lo";
  options.rate = 0;
  std::mutex mutex;  // DDS has threads
  std::vector<std::string> notices;
  options.notice = [&](const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex);
    notices.push_back(line);
  };
  const std::unique_ptr<DriveStream> drive = make_ros2_drive(options);
  const std::uint32_t clock = drive->add("/clock", ros::kClock, false);
  const double before = memory_in_use();
  Background flood("exec '" RUBBLE_DRIVER "' " + std::to_string(options.domain) + " flood",
                   scratch / "flood.txt");
  std::size_t most = 0, huge = 0;
  double slowest = 0;  // unit: s
  std::int64_t stamp = 0;
  const bool good = eventually(60, [&] {
    const auto begin = Clock::now();
    ++stamp;
    drive->write(clock, stamp, ros::clock(drive->version(), stamp));
    const DriveCommands commands = drive->take();
    slowest = std::max(slowest, std::chrono::duration<double>(Clock::now() - begin).count());
    most = std::max({most, commands.twists.size(), commands.joys.size()});
    for (const TwistCommand& each : commands.twists) {
      EXPECT_TRUE(std::isfinite(each.linear.x) && std::isfinite(each.angular.z));
      huge += each.linear.x > 1e300;  // which the camera's limits bound
    }
    return !commands.twists.empty() && commands.twists.back().linear.x == 0.125;
  });
  EXPECT_TRUE(good) << flood.output();
  EXPECT_GT(huge, 0u);
  EXPECT_LE(most, 100u);  // however many come between two steps
  EXPECT_LT(slowest, 2);  // a step waits for none of them
  EXPECT_LT(memory_in_use() - before, 300);
  drive->finish();
  EXPECT_GE(notices.size(), 2u);
  EXPECT_LE(notices.size(), 30u);  // not one for each
  EXPECT_EQ(flood.wait(30), 0) << flood.output();
}

}  // namespace ros2_misbehaviour_test
}  // namespace rubble::testing
