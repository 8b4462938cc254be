// `rubble drive --ros1`, driven by a rospy program and heard by rosbag.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/live/background.h"
#include "tests/live/driven.h"

namespace rubble::testing {
namespace {

TEST(LiveRos1Drive, WhatTopicsDriveRunsAgainByteForByte) {
  if (std::system("command -v rosmaster rosbag Xvfb >/dev/null") != 0)
    GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
  const ScratchFolder scratch;
  const std::string port = std::to_string(free_port());
  drive_in_a_window(scratch,
                    "export ROS_MASTER_URI=http://127.0.0.1:" + port + R"(
export ROS_IP=127.0.0.1 ROS_LOG_DIR=$d/log PYTHONUNBUFFERED=1
rosmaster --core -p )" + port + R"( >$d/master 2>&1 & master=$!
for i in $(seq 100); do timeout 5 rostopic list >/dev/null 2>&1 && break; sleep 0.1; done)",
                    "--ros1", R"(
rosbag record --quiet -O $d/live.bag /tf /camera/rgb/image_raw /camera/depth_registered/image_raw \
  >$d/record 2>&1 & record=$!
')" RUBBLE_PYTHON "' '" RUBBLE_SOURCE_DIR R"(/tests/live/drive_by_topics.py' $d/published || exit 1
kill -INT $record; wait $record)");
  if (!HasFatalFailure()) expect_the_drive_runs_again(scratch, true);
}

}  // namespace
}  // namespace rubble::testing
