// Programs of ROS 1 around a master of their own.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "tests/app/program.h"
#include "tests/live/background.h"

namespace rubble::testing {

class WithRos1Master : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v rosmaster >/dev/null") != 0) GTEST_SKIP() << "no rosmaster: see tools/packages-live.txt";
    port_ = free_port();
    uri_ = "http://127.0.0.1:" + std::to_string(port_);
    settings_ = "ROS_MASTER_URI=" + uri_ + " ROS_IP=127.0.0.1 PYTHONUNBUFFERED=1 ROS_LOG_DIR='" + (scratch_ / "log") + "' ";
  }
  std::unique_ptr<Background> start(const std::string& command, const std::string& output) const {
    return std::make_unique<Background>("exec env " + settings_ + command, scratch_ / output);
  }
  std::unique_ptr<Background> start_master() const {
    auto master = start("rosmaster --core -p " + std::to_string(port_), "master.txt");
    const std::string ask = "env " + settings_ + "timeout 5 rostopic list >/dev/null 2>&1";
    EXPECT_TRUE(eventually(30, [&] { return std::system(ask.c_str()) == 0; })) << master->output();
    return master;
  }

  ScratchFolder scratch_;
  int port_ = 0;
  std::string uri_, settings_;  // settings_: words before a command, as `env` takes them
};

}  // namespace rubble::testing
