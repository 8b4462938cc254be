// What recordings say of robots, by readers that are not ours: ROS's rosbag, the npm reader of MCAP files,
// Fast-CDR.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/base/atomic_file.h"
#include "io/recording/frame_order.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/rosbag_recorder.h"
#include "kernel/base/portable_math.h"
#include "tests/io/fast_cdr.h"
#include "tests/io/support.h"

namespace rubble {
namespace robot_topics_test {

using test::FastCdr;
using test::ScratchFolder;
using Json = nlohmann::json;

const Pose kStart{{0.8, 0, 0, 0.6}, {1, 2, 0.5}};

// A body with a wheel and a welded mast; the camera rides on the mast.
Recording robot_recording() {
  Recording recording;
  RobotRecord robot;
  robot.name = "cart";
  robot.links = {"base_link", "wheel", "mast"};
  robot.joints = {{"wheel_joint", 0, 1, false}, {"mast_joint", 0, 2, true}};
  robot.parent_from_child = {Pose{{}, {0.1, 0.2, 0}}, Pose{{}, {0, 0, 0.7}}};
  robot.world_from_base = kStart;
  robot.has_odometry = true;
  robot.description = "<robot name=\"cart\"/>";
  recording.robots = {robot};
  recording.mount = RigMount{"mast", {{}, {0.05, 0, 0}}};
  return recording;
}

RobotSample make_sample(int index) {
  RobotSample s;
  s.stamp_ns = test::make_frame(0).stamp_ns + index * 10'000'000;
  s.positions = {0.25 * index, 0}, s.speeds = {1.5, 0}, s.efforts = {-0.75, 0};
  s.parent_from_child = {Pose{portable::quat_from_rpy(0, 0.25 * index, 0), {0.1, 0.2, 0}},
                         Pose{{}, {0, 0, 0.7}}};
  s.contacts = {{}, {{1, 2, 30.5}, {-0.1, 0.2, 0.3}}, {}};
  s.odometry = RobotSample::Odometry{{portable::quat_from_rpy(0, 0, 0.1), {0.5 * index, 0.25, 0}}, 0.5, 0.125};
  s.world_from_base = kStart;
  s.linear_velocity = {0.4, 0.01, 0}, s.angular_velocity = {0, 0, 0.1};
  return s;
}

// Samples before, with and after frames.
void record(Recorder& recorder) {
  for (int i = 0; i < 3; ++i) recorder.write_robot(make_sample(i));
  recorder.write(test::make_frame(0));
  recorder.write_robot(make_sample(3));
  recorder.write(test::make_frame(1));
  recorder.finish();
}

RosOptions options() {
  RosOptions options;
  options.recording = robot_recording();
  return options;
}

// What both readers print.
void expect_robot(const Json& read) {
  const RobotSample last = make_sample(3);
  ASSERT_EQ(read["joints"].size(), 4U);
  EXPECT_EQ(read["joints"][3]["name"], Json({"wheel_joint"})) << "welds have no state";
  EXPECT_EQ(read["joints"][3]["position"], Json({last.positions[0]}));
  EXPECT_EQ(read["joints"][3]["velocity"], Json({1.5}));
  EXPECT_EQ(read["joints"][3]["effort"], Json({-0.75}));
  ASSERT_EQ(read["odom"].size(), 4U);
  EXPECT_EQ(read["odom"][3]["frame"], "odom");
  EXPECT_EQ(read["odom"][3]["child"], "base_link");
  EXPECT_EQ(read["odom"][3]["position"], Json({1.5, 0.25, 0.0}));
  EXPECT_EQ(read["odom"][3]["linear"], Json({0.5, 0.0, 0.0}));
  EXPECT_EQ(read["odom"][3]["angular"], Json({0.0, 0.0, 0.125}));
  EXPECT_EQ(read["truth"][3]["frame"], "world");
  EXPECT_EQ(read["truth"][3]["position"], Json({1.0, 2.0, 0.5}));
  EXPECT_EQ(read["contacts"].size(), 12U) << "one a link and sample";
  EXPECT_EQ(read["contacts"][10]["frame"], "wheel");
  EXPECT_EQ(read["contacts"][10]["force"], Json({1.0, 2.0, 30.5}));
  EXPECT_EQ(read["contacts"][10]["torque"], Json({-0.1, 0.2, 0.3}));
  EXPECT_EQ(read["description"], Json({"<robot name=\"cart\"/>"}));
  // Every frame has one parent, and every way leads to the world.
  const Json parents = {{"base_link", "odom"},      {"wheel", "base_link"},
                        {"mast", "base_link"},      {"odom", "world"},
                        {"camera_link", "mast"},    {"camera_optical_frame", "camera_link"}};
  EXPECT_EQ(read["parents"], parents);
}

TEST(RobotTopics, RosbagReadsThemWithTheSumsOfTheirDefinitions) {
  const ScratchFolder folder;
  record(*make_rosbag_recorder(folder / "a.bag", options()));
  const test::CommandResult read = test::run_command(
      std::string(RUBBLE_PYTHON) + " " + RUBBLE_SOURCE_DIR + "/tests/io/read_robots.py " + (folder / "a.bag"));
  ASSERT_EQ(read.exit_code, 0) << read.output;
  expect_robot(Json::parse(read.output));
}

TEST(RobotTopics, TheReaderOfMcapFilesReadsThemByTheirSchemas) {
  const ScratchFolder folder;
  record(*make_mcap_recorder(folder / "a.mcap", options()));
  const test::CommandResult read = test::run_node("read_robots.mjs", folder / "a.mcap");
  ASSERT_EQ(read.exit_code, 0) << read.output;
  expect_robot(Json::parse(read.output));
}

// Two cameras and two inertial units: one of each on the rig, one of each on a link.
TEST(RobotTopics, WhatALinkCarriesHangsOnThatLink) {
  RosOptions of = options();
  Recording& recording = of.recording;
  recording.mount.reset();
  recording.rig = "rig_link";
  recording.cameras.resize(2);
  recording.cameras[0].link = "left_link", recording.cameras[0].optical = "left_optical";
  CameraRecord& carried = recording.cameras[1];
  carried.topic = "/eye", carried.truth_topic = "/eye/ground_truth", carried.link = "eye_link", carried.optical = "eye_optical";
  carried.carrier = "wheel", carried.rig_from_camera.translation = {0.1, 0, 0};
  recording.imus.resize(2);
  recording.imus[0].frame_id = "rig_link";
  recording.imus[1].topic = "/eye_imu", recording.imus[1].frame_id = "eye_imu_link";
  recording.imus[1].carrier = "mast";
  recording.sensors.push_back({"lidar", "/points", "lidar_link", "base_link", {}, std::make_shared<test::FixedObservation>(RawlogObservation())});
  const ScratchFolder folder;
  const auto recorder = make_rosbag_recorder(folder / "a.bag", of);
  for (int i = 0; i < 2; ++i) {
    recorder->write_robot(make_sample(i));
    for (int camera = 1; camera >= 0; --camera) {  // the carried one first: the rig's pose comes with the other
      Frame frame = test::make_frame(i);
      frame.sensor = camera;
      if (camera == 1) frame.world_from_camera.translation = {4, 5, 6.0 + i};
      recorder->write(frame);
    }
  }
  recorder->finish();
  const test::CommandResult read = test::run_command(
      std::string(RUBBLE_PYTHON) + " " + RUBBLE_SOURCE_DIR + "/tests/io/read_robots.py " + (folder / "a.bag"));
  ASSERT_EQ(read.exit_code, 0) << read.output;
  const Json parents = {{"base_link", "odom"},       {"wheel", "base_link"},      {"mast", "base_link"},
                        {"odom", "world"},           {"rig_link", "world"},       {"left_link", "rig_link"},
                        {"left_optical", "left_link"}, {"eye_link", "wheel"},     {"eye_optical", "eye_link"},
                        {"eye_imu_link", "mast"},    {"lidar_link", "base_link"}};
  EXPECT_EQ(Json::parse(read.output)["parents"], parents);
  const Json poses = Json::parse(read.output)["poses"];
  EXPECT_EQ(poses["/eye/ground_truth/pose"], Json({{"world", 4.0, 5.0, 6.0}, {"world", 4.0, 5.0, 7.0}}));
  EXPECT_EQ(poses["/ground_truth/pose"].size(), 2U);
}

// Of two inertial units, that on the camera's carrier is the one of its files.
TEST(RobotTopics, ACameraAloneHasTheInertialUnitBesideIt) {
  Recording recording = robot_recording();
  recording.cameras.resize(2);
  recording.cameras[1].carrier = "mast";
  recording.imus.resize(2);
  recording.imus[0].carrier = "mast", recording.imus[0].name = "high";
  EXPECT_EQ(find_imu_beside(recording, 0), 1);
  EXPECT_EQ(find_imu_beside(recording, 1), 0);
  const Recording alone = recording.of_camera(1);
  ASSERT_EQ(alone.imus.size(), 1U);
  EXPECT_EQ(alone.imus[0].name, "high");
}

class RobotCdr : public ::testing::TestWithParam<std::string> {
 protected:
  static constexpr ros::Version kRos2 = ros::Version::ros2;
  ros::Header header_{7, 1'700'000'000'123'456'789, GetParam()};
};

TEST_P(RobotCdr, MessagesEqualFastCdr) {
  const std::vector<std::string> names{"a", "wheel"};
  const std::vector<double> q{0.5, -1}, u{2, 3}, effort{1e-3, 7};
  FastCdr joints;
  joints.header(header_) << names << q << u << effort;
  EXPECT_EQ(ros::joint_state(kRos2, header_, names, q, u, effort), joints.bytes());
  FastCdr odometry;
  odometry.header(header_) << std::string("base_link");
  std::array<double, 36> exact{};
  for (std::size_t axis = 0; axis < 6; ++axis) exact[7 * axis] = 1e-9;
  odometry.pose(kStart) << exact;
  odometry.vector({1, 2, 3}).vector({4, 5, 6}) << exact;
  EXPECT_EQ(ros::true_odometry(kRos2, header_, "base_link", kStart, {1, 2, 3}, {4, 5, 6}), odometry.bytes());
  RobotSample::Odometry reading{kStart, 0.5, -0.25, {{{4, 1, 2}, {1, 5, 3}, {2, 3, 6}}}, 7, 8};
  std::array<double, 36> of_pose{}, of_twist{};
  of_pose[0] = 4 + 1e-6, of_pose[1] = of_pose[6] = 1, of_pose[5] = of_pose[30] = 2;
  of_pose[7] = 5 + 1e-6, of_pose[11] = of_pose[31] = 3, of_pose[35] = 6 + 1e-6;
  of_twist[0] = of_twist[7] = 7 + 1e-6, of_twist[35] = 8 + 1e-6;
  for (const std::size_t axis : {2, 3, 4}) of_pose[7 * axis] = of_twist[7 * axis] = 1e6;
  FastCdr reckoned;
  reckoned.header(header_) << std::string("base_link");
  reckoned.pose(kStart) << of_pose;
  reckoned.vector({0.5, 0, 0}).vector({0, 0, -0.25}) << of_twist;
  EXPECT_EQ(ros::odometry(kRos2, header_, "base_link", reading), reckoned.bytes());
  EXPECT_EQ(ros::wrench_stamped(kRos2, header_, {1, 2, 3}, {4, 5, 6}),
            FastCdr().header(header_).vector({1, 2, 3}).vector({4, 5, 6}).bytes());
}

TEST_P(RobotCdr, MessagesOfSensorsEqualFastCdr) {
  FastCdr range;
  range.header(header_) << std::uint8_t{1} << 0.5f << 0.25f << 4.0f << 1.5f;
  EXPECT_EQ(ros::range(kRos2, header_, true, 0.5, 0.25, 4, 1.5), range.bytes());
  EXPECT_EQ(ros::boolean(kRos2, true), (FastCdr() << std::uint8_t{1}).bytes());
  FastCdr pressure;
  pressure.header(header_) << 101325.0 << 4.0;
  EXPECT_EQ(ros::fluid_pressure(kRos2, header_, 101325, 4), pressure.bytes());
  FastCdr field;
  field.header(header_).vector({1e-5, 2e-5, -4e-5}) << std::array<double, 9>{9, 0, 0, 0, 9, 0, 0, 0, 9};
  EXPECT_EQ(ros::magnetic_field(kRos2, header_, {1e-5, 2e-5, -4e-5}, 9), field.bytes());
  FastCdr fix;
  fix.header(header_) << std::int8_t{0} << std::uint16_t{1} << 42.5 << -71.25 << 17.0;
  fix << std::array<double, 9>{1, 0, 0, 0, 2, 0, 0, 0, 3} << std::uint8_t{2};
  EXPECT_EQ(ros::nav_sat_fix(kRos2, header_, true, 42.5, -71.25, 17, {1, 2, 3}), fix.bytes());
  FastCdr attitude;
  const std::array<double, 9> none{-1, 0, 0, 0, 0, 0, 0, 0, 0};
  attitude.header(header_) << 0.1 << 0.2 << 0.3 << 0.9 << std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 4};
  attitude.vector({}) << none;
  attitude.vector({}) << none;
  EXPECT_EQ(ros::attitude(kRos2, header_, {0.9, 0.1, 0.2, 0.3}, {1, 1, 4}), attitude.bytes());
}

INSTANTIATE_TEST_SUITE_P(Frames, RobotCdr,
                         ::testing::Values("", "a", "ab", "abc", "abcd", "abcde", "abcdef", "abcdefg"));

}  // namespace robot_topics_test
}  // namespace rubble
