// `rubble drive --ros2`, driven by Fast DDS with what Fast CDR writes (fastdds_driver.cpp).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/live/driven.h"

namespace rubble::testing {
namespace ros2_drive_test {

TEST(NightlyLiveRos2Drive, WhatTopicsDriveRunsAgainByteForByte) {
  if (std::system("command -v Xvfb >/dev/null") != 0) GTEST_SKIP() << "no Xvfb";
  const ScratchFolder scratch;
  const std::string domain = std::to_string(101 + getpid() % 100);
  drive_in_a_window(scratch, "", "--ros2 --ros-domain " + domain,
                    "'" RUBBLE_DRIVER "' " + domain + " >$d/published || exit 1");
  if (!HasFatalFailure()) expect_the_drive_runs_again(scratch, false);
}

TEST(NightlyLiveRos2Drive, ARobotGoesAsTopicsAskAndRunsAgainWithTheSameBits) {
  if (std::system("command -v Xvfb >/dev/null") != 0) GTEST_SKIP() << "no Xvfb";
  const ScratchFolder scratch;
  write_robot_mission(scratch);
  const std::string domain = std::to_string(101 + getpid() % 100);
  drive_in_a_window(scratch, "", "--ros2 --ros-domain " + domain,
                    "'" RUBBLE_DRIVER "' " + domain + " robot >$d/published || exit 1", "$d/robot.lua");
  if (!HasFatalFailure()) expect_the_robot_runs_again(scratch, false);
}

}  // namespace ros2_drive_test
}  // namespace rubble::testing
