// `--ros2` against another maker's DDS: fastdds_listener.cpp hears by Fast DDS what is published by
// Cyclone DDS, on the loopback interface, with the names and qualities of service of ROS 2.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/ros/ros_message_reader.h"
#include "tests/app/program.h"
#include "tests/live/background.h"

namespace rubble::testing {
namespace ros2_test {

struct Topic {
  std::string name, type;  // as DDS knows them
  int count;               // of a flight of three frames
};
const std::vector<Topic> kTopics{
    {"/clock", "rosgraph_msgs::msg::dds_::Clock_", 3},
    {"/tf", "tf2_msgs::msg::dds_::TFMessage_", 3},
    {"/tf_static", "tf2_msgs::msg::dds_::TFMessage_", 1},
    {"/ground_truth/pose", "geometry_msgs::msg::dds_::PoseStamped_", 3},
    {"/camera/rgb/image_raw", "sensor_msgs::msg::dds_::Image_", 3},
    {"/camera/rgb/camera_info", "sensor_msgs::msg::dds_::CameraInfo_", 3},
    {"/camera/depth_registered/image_raw", "sensor_msgs::msg::dds_::Image_", 3},
    {"/camera/depth_registered/camera_info", "sensor_msgs::msg::dds_::CameraInfo_", 3},
};

using Messages = std::map<std::string, std::vector<std::string>>;  // of each topic

Messages read_recording(const std::string& path) {
  Messages messages;
  const auto fault = read_mcap(path, [&](const RosMessage& message) {
    messages[std::string(message.topic)].emplace_back(message.bytes);
    return true;
  });
  EXPECT_FALSE(fault);
  return messages;
}

class LiveRos2 : public ::testing::Test {
 protected:
  void SetUp() override { write_file(scratch_ / "tiny.lua", kTinyMission); }

  // A domain of this test's own, from those whose ports are free on Linux.
  int domain() const { return 1 + int(getpid()) % 100; }

  std::string rubble(const std::string& options) const {
    return "exec env -u CYCLONEDDS_URI -u ROS_DOMAIN_ID '" RUBBLE_PROGRAM "' run '" +
           (scratch_ / "tiny.lua") + "' --out '" + (scratch_ / "out") +
           "' --force --set outputs.mcap=true --ros2 --ros-domain " + std::to_string(domain()) + " " +
           options;
  }
  // What it hears comes into the folder `name`.
  std::string listen(const std::string& name, int seconds, const std::string& options,
                     const std::vector<Topic>& topics) const {
    std::filesystem::create_directories(scratch_ / name);
    std::string command = "exec '" RUBBLE_LISTENER "' '" + (scratch_ / name) + "' " +
                          std::to_string(domain()) + " " + std::to_string(seconds) + " " + options;
    for (const Topic& topic : topics)
      command += " " + topic.name + " " + topic.type + " " + std::to_string(topic.count);
    return command;
  }
  void expect_ready(const Background& listener) const {
    EXPECT_TRUE(eventually(20, [&] { return listener.output().find("ready") != std::string::npos; }))
        << listener.output();
  }

  // DDS sends whole words: up to three zeros may stand behind a message.
  void expect_same(const std::string& name, const Messages& recorded) const {
    for (std::size_t i = 0; i < kTopics.size(); ++i) {
      const std::vector<std::string>& wanted = recorded.at(kTopics[i].name);
      ASSERT_EQ(int(wanted.size()), kTopics[i].count) << kTopics[i].name;
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        const std::string heard =
            read_file(scratch_ / (name + "/" + std::to_string(i) + "." + std::to_string(k)));
        ASSERT_EQ(heard.size(), (wanted[k].size() + 3) / 4 * 4) << kTopics[i].name << " " << k;
        EXPECT_TRUE(heard.substr(0, wanted[k].size()) == wanted[k]) << kTopics[i].name << " " << k;
      }
    }
  }

  ScratchFolder scratch_;
};

using NightlyLiveRos2 = LiveRos2;

TEST_F(LiveRos2, AnotherMakersDdsHearsWhatTheMcapFileHolds) {
  Background listener(listen("heard", 60, "", kTopics), scratch_ / "listener.txt");
  expect_ready(listener);
  // Pictures of a megabyte: hundreds of fragments.
  Background run(rubble("--rate fast --wait-for-subscribers 30 --set camera.width=640 "
                        "--set camera.height=480"),
                 scratch_ / "run.txt");
  EXPECT_EQ(run.wait(60), 0) << run.output();
  EXPECT_EQ(listener.wait(60), 0) << listener.output();
  const Messages recorded = read_recording(scratch_ / "out/mission.mcap");
  expect_same("heard", recorded);
  // A run of another seed is not the same.
  ASSERT_EQ(run_rubble("run '" + (scratch_ / "tiny.lua") + "' --seed 4 --set outputs.mcap=true --set " +
                       "camera.width=640 --set camera.height=480 --out '" + (scratch_ / "4") + "'")
                .exit_code,
            0);
  EXPECT_NE(read_recording(scratch_ / "4/mission.mcap"), recorded);
}

TEST_F(NightlyLiveRos2, SensorDataReadersHearItAndLateOnesTheStaticTransforms) {
  std::vector<Topic> topics = kTopics;
  topics.erase(topics.begin() + 2);  // best effort is for what comes again
  for (Topic& each : topics) each.count = 5;
  Background run(rubble("--set 'trajectory.waypoints[2].t=8'"), scratch_ / "run.txt");
  Background first(listen("clock", 30, "", {{"/clock", "rosgraph_msgs::msg::dds_::Clock_", 2}}),
                   scratch_ / "first.txt");
  EXPECT_EQ(first.wait(40), 0) << first.output() << run.output();  // so the run is under way
  Background late(listen("static", 8, "", {kTopics[2]}), scratch_ / "static.txt");
  Background best_effort(listen("sensor", 8, "--sensor-data", topics), scratch_ / "sensor.txt");
  EXPECT_EQ(late.wait(20), 0) << late.output();
  EXPECT_EQ(best_effort.wait(20), 0) << best_effort.output();
  EXPECT_EQ(run.wait(60), 0) << run.output();
  const Messages recorded = read_recording(scratch_ / "out/mission.mcap");
  const std::string heard = read_file(scratch_ / "static/0.0");
  EXPECT_EQ(heard.substr(0, recorded.at("/tf_static")[0].size()), recorded.at("/tf_static")[0]);
}

// In a network of its own, where discovery may be shouted: an interface that leads nowhere.
TEST_F(NightlyLiveRos2, OnARealInterfaceItIsHeardByFastDdsAsInstalled) {
  const std::string network =
      "ip link set lo up && ip link add cam0 type bridge && ip addr add 10.77.0.1/24 dev cam0 && "
      "ip link set cam0 up multicast on && ip route add 224.0.0.0/4 dev cam0";
  if (std::system(("unshare -Urn sh -c '" + network + "' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "no network namespaces here";
  write_file(scratch_ / "both.sh",
             network + "\n(" + listen("heard", 60, "--as-installed", kTopics) + ") & listener=$!\n(" +
                 rubble("--rate fast --wait-for-subscribers 30 --ros-interface cam0") +
                 ") || exit 1\nwait $listener\n");
  Background both("exec unshare -Urn sh '" + (scratch_ / "both.sh") + "'", scratch_ / "both.txt");
  EXPECT_EQ(both.wait(100), 0) << both.output();
  expect_same("heard", read_recording(scratch_ / "out/mission.mcap"));
}

// Without room for what it has not confirmed each picture would wait a tenth of a second for it.
TEST_F(NightlyLiveRos2, AReaderThatStopsReadingHoldsNothingUp) {
  const auto seconds_of_a_run = [&] {
    const auto begin = std::chrono::steady_clock::now();
    Background run(rubble("--rate fast --wait-for-subscribers 30 --set camera.width=640 --set "
                          "camera.height=480 --set 'trajectory.waypoints[2].t=6'"),
                   scratch_ / "run.txt");
    EXPECT_EQ(run.wait(100), 0) << run.output();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  Background listener(listen("heard", 200, "", kTopics), scratch_ / "listener.txt");
  expect_ready(listener);
  const double alone = seconds_of_a_run();  // and the shaders and the pile are known afterwards
  EXPECT_EQ(listener.wait(20), 0) << listener.output();
  Background stopped(listen("stopped", 200, "", kTopics), scratch_ / "stopped.txt");
  expect_ready(stopped);
  Background stop("exec sh -c 'while ! [ -e \"" + (scratch_ / "stopped/0.0") +
                      "\" ]; do sleep 0.02; done; kill -STOP " + std::to_string(stopped.pid()) + "'",
                  scratch_ / "stop.txt");
  const double beside = seconds_of_a_run();
  EXPECT_EQ(stop.wait(1), 0);
  stopped.signal(SIGCONT);
  EXPECT_LT(beside, alone + 5);  // two seconds are given to readers at the end
}

TEST_F(LiveRos2, WhatCannotStartIsSaidBeforeAnythingIsMade) {
  const std::string run = "run scripts/small.lua --out '" + (scratch_ / "none") + "' ";
  const Outcome nowhere = run_rubble(run + "--ros2 --ros-interface nowhere7");
  EXPECT_EQ(nowhere.exit_code, 2) << nowhere.err;
  EXPECT_NE(nowhere.err.find("nowhere7"), std::string::npos) << nowhere.err;
  EXPECT_EQ(run_rubble(run + "--ros2 --ros-domain 233").exit_code, 1);
  EXPECT_EQ(run_rubble(run + "--ros-domain 3").exit_code, 1);
  const Outcome variable = run_rubble(run + "--ros2", "env ROS_DOMAIN_ID=three");
  EXPECT_EQ(variable.exit_code, 1);
  EXPECT_NE(variable.err.find("ROS_DOMAIN_ID"), std::string::npos) << variable.err;
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "none"));
}

}  // namespace ros2_test
}  // namespace rubble::testing
