#include "tests/live/driven.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/app/driven_leg.h"

namespace rubble::testing {

void drive_in_a_window(const ScratchFolder& scratch, const std::string& before,
                       const std::string& options, const std::string& beside) {
  write_file(scratch / "drive.sh", "d='" + scratch.path().string() + R"('
Xvfb -displayfd 3 -screen 0 448x168x24 -nolisten tcp 3>$d/display >/dev/null 2>&1 & screen=$!
master=
trap 'kill $screen $master' EXIT
)" + before + R"(
for i in $(seq 100); do [ -s $d/display ] && break; sleep 0.1; done
export DISPLAY=:$(cat $d/display)
unset SDL_VIDEODRIVER
env -u ROS_IP -u CYCLONEDDS_URI -u ROS_DOMAIN_ID ')" RUBBLE_PROGRAM R"(' drive scripts/small.lua \
  --size 160x120 --record --set outputs.rawlog=false --set outputs.stl=false \
  --set trajectory.rate_hz=10 --out $d/out )" + options + R"( >$d/stdout 2>$d/stderr & drive=$!
for i in $(seq 600); do kill -0 $drive || exit 1; grep -q 'drive: ready' $d/stderr && break; sleep 0.1; done
)" + beside + R"(
wait $drive
)");
  ASSERT_EQ(std::system(("cd '" RUBBLE_SOURCE_DIR "' && timeout 120 bash '" + (scratch / "drive.sh") + "'")
                            .c_str()),
            0)
      << read_file(scratch / "stderr") << read_file(scratch / "published");
}

void expect_the_drive_runs_again(const ScratchFolder& scratch, bool heard) {
  expect_same_frames(scratch, "leg_001", 4);
  expect_same_frames(scratch, "leg_002", 4);
  const std::string check = RUBBLE_PYTHON " '" RUBBLE_SOURCE_DIR "/tests/live/check_drive.py' '" +
                            scratch.path().string() + (heard ? "' heard" : "' unheard");
  EXPECT_EQ(std::system(check.c_str()), 0);
  EXPECT_NE(read_file(scratch / "stderr").find("/cmd_vel: what came is no geometry_msgs/Twist"),
            std::string::npos)  // of the one with NaN
      << read_file(scratch / "stderr");
}

}  // namespace rubble::testing
