// /cmd_vel and /joy as what is asked of the camera, from the bytes on the wire on.
#include <gtest/gtest.h>

#include "app/drive/driven_camera.h"
#include "app/drive/remote_controls.h"
#include "io/live/drive_commands.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "tests/app/settled_mission.h"

namespace rubble::testing {
namespace remote_controls_test {

constexpr double kStep = 1.0 / 30;

DriveCommands twist(const Vec3& linear, const Vec3& angular) {
  DriveCommands commands;
  commands.twists.push_back({linear, angular});
  return commands;
}

DriveCommands joy(std::vector<float> axes, std::vector<std::int32_t> buttons = {}) {
  DriveCommands commands;
  commands.joys.push_back({std::move(axes), std::move(buttons)});
  commands.joy_connected = true;
  return commands;
}

DriveInput take(RemoteControls& controls, const DriveCommands& commands) {
  DriveInput input;
  controls.hear(commands, kStep);
  controls.add_to(input);
  return input;
}

TEST(RemoteControls, ATwistHoldsForHalfASecondOfSimulation) {
  RemoteControls controls;
  take(controls, twist({9, 9, 9}, {}));
  DriveInput input = take(controls, twist({0.4, -0.1, 0.2}, {0.1, 0.2, 0.3}));
  EXPECT_EQ(input.linear.x, 0.4);  // the last, and not both
  EXPECT_EQ(input.linear.y, -0.1);
  EXPECT_EQ(input.angular.z, 0.3);
  EXPECT_EQ(input.forward, 0);
  int steps = 1;
  while (norm(take(controls, {}).linear) > 0) ASSERT_LT(++steps, 100);
  EXPECT_EQ(steps, 15 + 1);  // that of its coming, and half a second
}

TEST(RemoteControls, SticksHoldUntilTheirPublisherIsGone) {
  RemoteControls controls;
  DriveInput input = take(controls, joy({0.25f, 0.5f, 1, -0.75f, 1, 1, 0, 0}));
  EXPECT_EQ(input.forward, 0.5);
  EXPECT_EQ(input.roll, -0.25);  // stick to the left: rolls to the left
  EXPECT_EQ(input.yaw, -0.75);   // to the right: turns right
  EXPECT_EQ(input.pitch, -1);    // up: raises the nose
  DriveCommands silence;
  silence.joy_connected = true;
  EXPECT_EQ(take(controls, silence).forward, 0.5);
  EXPECT_EQ(take(controls, {}).forward, 0);
}

TEST(RemoteControls, AButtonIsPressedOnceAndSmallJoysticksDo) {
  RemoteControls controls;
  const std::vector<std::int32_t> lamp{1};
  EXPECT_EQ(take(controls, joy({0, 0, 0, 0, 0, 0, 0, 1}, lamp)).actions,
            (std::vector<DriveAction>{DriveAction::lamp_up, DriveAction::lamp}));
  EXPECT_TRUE(take(controls, joy({0, 0, 0, 0, 0, 0, 0, 1}, lamp)).actions.empty());
  EXPECT_TRUE(take(controls, joy({}, {})).actions.empty());  // released
  EXPECT_EQ(take(controls, joy({}, lamp)).actions, std::vector<DriveAction>{DriveAction::lamp});
}

TEST(RemoteControls, MoveTheCameraAsMuchAsTheySayAndNoMoreThanTheLimits) {
  const SettledMission empty = settle_text("return rubble.mission { pile = { layers = 0 } }");
  const PileQueries queries = empty.queries();
  DriveLimits limits;
  limits.most_speed = 2;
  limits.most_turn_rate_deg = 45;
  RemoteControls controls;
  const auto drive = [&](const Vec3& linear, const Vec3& angular) {
    DrivenCamera camera({{0, 0, 1}, {0, 0, 90}}, Plan::ghost, 0.1, queries, limits);
    for (int i = 0; i < 30; ++i) camera.step(take(controls, twist(linear, angular)), kStep);
    return camera.pose();
  };
  const Vec3 aside = drive({0.3, 0.5, 0.25}, {}).position;  // looking along Y: left is -X
  EXPECT_NEAR(aside.x, -0.5, 1e-12);
  EXPECT_NEAR(aside.y, 0.3, 1e-12);
  EXPECT_NEAR(aside.z, 1.25, 1e-12);
  EXPECT_NEAR(drive({30, 40, 0}, {}).position.y, 2 * 0.6, 1e-9);
  EXPECT_NEAR(drive({}, {0, 0, 0.5}).rpy_deg.z, 90 + 0.5 * 180 / portable::kPi, 1e-9);
  EXPECT_NEAR(drive({}, {0, 0, 1000}).rpy_deg.z, 135, 1e-9);
  // Finite, but their squares are not.
  EXPECT_NEAR(drive({1.5e308, 0, 0}, {}).position.y, 2, 1e-9);
  EXPECT_NEAR(drive({}, {0, 0, -1.5e308}).rpy_deg.z, 45, 1e-9);
}

// A point with two joints.
void add_point(ros::Wire& wire, double position, std::int32_t second) {
  wire.count(2), wire.number(position), wire.number(-0.5);
  wire.count(2), wire.number(0.25), wire.number(0.125);
  wire.count(0);                    // accelerations
  wire.count(1), wire.number(9.0);  // efforts
  wire.number(second), wire.number(std::int32_t{500000000});
}

TEST(RemoteControls, ATrajectoryIsReadAndWhatIsNoneIsRefused) {
  for (const ros::Version version : {ros::Version::ros1, ros::Version::ros2}) {
    const auto message = [version](double position) {
      ros::Wire wire(version);
      if (version == ros::Version::ros1) wire.number(std::uint32_t{7});
      wire.time(1000000000);
      wire.text("base_link");
      wire.count(2), wire.text("elbow"), wire.text("wrist");
      wire.count(2);
      add_point(wire, 1.5, 1);
      add_point(wire, position, 3);
      return wire.take();
    };
    const std::string bytes = message(2.5);
    const JointTrajectoryCommand read = read_joint_trajectory(version, bytes);
    EXPECT_EQ(read.joints, (std::vector<std::string>{"elbow", "wrist"}));
    ASSERT_EQ(read.points.size(), 2U);
    EXPECT_EQ(read.points[1].positions, (std::vector<double>{2.5, -0.5}));
    EXPECT_EQ(read.points[1].velocities, (std::vector<double>{0.25, 0.125}));
    EXPECT_EQ(read.points[0].time, 1.5);
    EXPECT_EQ(read.points[1].time, 3.5);
    EXPECT_THROW(read_joint_trajectory(version, message(std::nan(""))), RunError);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_THROW(read_joint_trajectory(version, bytes.substr(0, size)), RunError) << size;
  }
}

// Each is passed on once; the twist beside it still holds.
TEST(RemoteControls, TrajectoriesArePassedOnOnce) {
  RemoteControls controls;
  DriveCommands commands = twist({0.5, 0, 0}, {});
  commands.trajectories = {{{"elbow"}, {}}, {{"wrist"}, {}}};
  const DriveInput first = take(controls, commands), second = take(controls, {});
  ASSERT_EQ(first.trajectories.size(), 2U);
  EXPECT_EQ(first.trajectories[1].joints, (std::vector<std::string>{"wrist"}));
  EXPECT_TRUE(second.trajectories.empty());
  EXPECT_EQ(second.linear.x, 0.5);
}

TEST(RemoteControls, WhatIsNoMessageIsRefused) {
  for (const ros::Version version : {ros::Version::ros1, ros::Version::ros2}) {
    ros::Wire wire(version);
    for (int i = 0; i < 6; ++i) wire.number(double(i));
    std::string bytes = wire.take();
    EXPECT_EQ(read_twist(version, bytes).angular.y, 4);
    EXPECT_THROW(read_twist(version, bytes.substr(0, bytes.size() - 1)), RunError);
    ros::Wire bad(version);
    for (int i = 0; i < 6; ++i) bad.number(std::nan(""));
    EXPECT_THROW(read_twist(version, bad.take()), RunError);

    ros::Wire stick(version);
    if (version == ros::Version::ros1) stick.number(std::uint32_t{7});
    stick.time(1000000000);
    stick.text("pad");
    stick.count(2), stick.number(0.5f), stick.number(-1.0f);
    stick.count(3);
    for (const std::int32_t button : {0, 1, 0}) stick.number(button);
    bytes = stick.take();
    EXPECT_EQ(read_joy(version, bytes).axes, (std::vector<float>{0.5f, -1}));
    EXPECT_EQ(read_joy(version, bytes).buttons, (std::vector<std::int32_t>{0, 1, 0}));
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_THROW(read_joy(version, bytes.substr(0, size)), RunError) << size;
  }
}

}  // namespace remote_controls_test
}  // namespace rubble::testing
