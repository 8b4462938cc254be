// `rubble drive --ros1` in a window on a screen of its own, driven by programs of ROS alone.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/program.h"
#include "tests/live/background.h"

namespace rubble::testing {
namespace {

// A master, a screen, the drive; then its camera is driven: two seconds of /cmd_vel, the lamp and a
// stick by /joy, and the button that ends it.
const char* const kScript = R"(
d=$1; program=$2; port=$3
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_LOG_DIR=$d/log PYTHONUNBUFFERED=1
rosmaster --core -p $port >$d/master 2>&1 & master=$!
Xvfb -displayfd 3 -screen 0 448x168x24 -nolisten tcp 3>$d/display >/dev/null 2>&1 & xvfb=$!
trap 'kill $xvfb $master' EXIT
for i in $(seq 100); do [ -s $d/display ] && break; sleep 0.1; done
for i in $(seq 100); do timeout 5 rostopic list >/dev/null 2>&1 && break; sleep 0.1; done
export DISPLAY=:$(cat $d/display)
unset SDL_VIDEODRIVER
env -u ROS_IP $program drive scripts/small.lua --size 160x120 --record --ros1 \
  --set outputs.rawlog=false --set outputs.stl=false --set trajectory.rate_hz=10 --out $d/out \
  >$d/stdout 2>$d/stderr & drive=$!
for i in $(seq 600); do kill -0 $drive || exit 1; grep -q 'drive: ready' $d/stderr && break; sleep 0.1; done
rosbag record --quiet -O $d/live.bag /tf /camera/rgb/image_raw /camera/depth_registered/image_raw \
  >$d/record 2>&1 & record=$!
$4 $5 $d/published
kill -INT $record; wait $record
wait $drive
)";

TEST(LiveRos1Drive, WhatTopicsDriveRunsAgainByteForByte) {
  if (std::system("command -v rosmaster rosbag Xvfb >/dev/null") != 0)
    GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const ScratchFolder scratch;
  write_file(scratch / "drive.sh", kScript);
  const std::string command =
      "cd '" RUBBLE_SOURCE_DIR "' && timeout 120 bash " + (scratch / "drive.sh") + " " +
      scratch.path().string() + " " RUBBLE_PROGRAM " " + std::to_string(free_port()) +
      " " RUBBLE_PYTHON " " RUBBLE_SOURCE_DIR "/tests/live/drive_by_topics.py";
  ASSERT_EQ(std::system(command.c_str()), 0)
      << read_file(scratch / "stderr") << read_file(scratch / "published");
  EXPECT_NE(read_file(scratch / "stderr").find("/cmd_vel: what came is no geometry_msgs/Twist"),
            std::string::npos)  // of the one with NaN
      << read_file(scratch / "stderr");

  for (const std::string leg : {"leg_001", "leg_002"}) {
    const Outcome again = run_rubble("run " + (scratch / "out/") + leg + ".lua --quiet --out " +
                                     (scratch / leg));
    ASSERT_EQ(again.exit_code, 0) << again.err;
    const auto json = nlohmann::json::parse(read_file(scratch / (leg + "/manifest.json")));
    std::istringstream seen(read_file(scratch / ("out/" + leg + ".hashes")));
    std::string row;
    std::getline(seen, row);
    std::size_t frames = 0;
    for (; std::getline(seen, row); ++frames)
      ASSERT_EQ(row, json["frame_hashes"]["xxh64"].at(frames)) << leg << " frame " << frames;
    EXPECT_EQ(frames, json["frame_hashes"]["xxh64"].size());
    EXPECT_GT(frames, 3u);
  }
  // What was asked for is what was driven, and what was heard is what was recorded.
  const std::string check = RUBBLE_PYTHON " " RUBBLE_SOURCE_DIR "/tests/live/check_drive.py " +
                            scratch.path().string();
  EXPECT_EQ(std::system(check.c_str()), 0);
}

}  // namespace
}  // namespace rubble::testing
