// The driven camera, and its path written down and read back.
#include <gtest/gtest.h>

#include "app/drive/drive_log.h"
#include "kernel/base/portable_math.h"
#include "tests/app/settled_mission.h"

namespace rubble::testing {
namespace drive_motion_test {

constexpr double kStep = 1.0 / 30;

// A wall of a metre at x = 2, and nothing else.
const char* const kWall = R"(return rubble.mission {
  pile = { layers = 0, placed = { { box = { 1, 4, 4 }, position = { 2.5, 0, 2 } } } } })";

DriveInput held(double forward, double roll = 0, double pitch = 0, double yaw = 0) {
  DriveInput input;
  input.forward = forward, input.roll = roll, input.pitch = pitch, input.yaw = yaw;
  return input;
}

Vec3 drive_for(DrivenCamera& camera, const DriveInput& input, int steps) {
  for (int i = 0; i < steps; ++i) camera.step(input, kStep);
  return camera.pose().position;
}

TEST(DrivenCamera, GoesAlongItsAxisAtItsSpeedAndTurnsAtItsRate) {
  const SettledMission wall = settle_text(kWall);
  const PileQueries queries = wall.queries();
  DrivenCamera camera({{0, 0, 1}, {0, 0, 90}}, Plan::ghost, 0.1, queries);
  const Vec3 there = drive_for(camera, held(1), 30);
  EXPECT_NEAR(there.x, 0, 1e-12);
  EXPECT_NEAR(there.y, 0.5, 1e-12);
  drive_for(camera, held(0, 0, 0, 1), 30);
  EXPECT_NEAR(camera.pose().rpy_deg.z, 150, 1e-9);
  // Straight up, where yaw has no meaning, and beyond.
  DrivenCamera looping({{0, 0, 1}, {}}, Plan::ghost, 0.1, queries);
  drive_for(looping, held(0, 0, -1), 45);
  EXPECT_NEAR(looping.pose().world_from_camera().rotation.rotate({1, 0, 0}).z, 1, 1e-9);
  drive_for(looping, held(0, 0, -1), 45);
  EXPECT_NEAR(looping.pose().world_from_camera().rotation.rotate({1, 0, 0}).x, -1, 1e-9);
}

TEST(DrivenCamera, StopsSlidesOrGoesThroughAsThePlanSays) {
  const SettledMission wall = settle_text(kWall);
  const PileQueries queries = wall.queries();
  const DrivenPose slanted{{0, 0, 1}, {0, 0, 30}};
  DrivenCamera refused(slanted, Plan::refuse, 0.2, queries);
  const Vec3 stopped = drive_for(refused, held(1), 150);
  EXPECT_TRUE(refused.held_back());
  EXPECT_NEAR(stopped.x, 1.8, 3e-3);
  EXPECT_GE(queries.clearance(stopped), 0.2);
  EXPECT_GT(1.8, drive_for(refused, held(-1), 10).x);  // and comes away again
  DrivenCamera sliding(slanted, Plan::avoid, 0.2, queries);
  const Vec3 slid = drive_for(sliding, held(1), 150);
  EXPECT_GT(slid.y, stopped.y + 0.1);
  EXPECT_GE(queries.clearance(slid), 0.2);
  DrivenCamera ghost(slanted, Plan::ghost, 0.2, queries);
  EXPECT_NEAR(drive_for(ghost, held(1), 150).x, 2.5 * std::cos(portable::kPi / 6), 1e-9);
}

TEST(DriveLog, TheMissionGivesThePosesAgainBitForBit) {
  Scenario scenario = settle_text(kWall).mission.scenario;
  scenario.trajectory.rate_hz = 30;
  adapt_to_driving(scenario);
  const SettledMission wall = settle_text(kWall);
  const PileQueries queries = wall.queries();
  DrivenCamera camera({{-1, 0.25, 1}, {}}, Plan::ghost, 0.1, queries);
  DriveLog log(scenario);
  std::vector<Pose> driven;
  for (int i = 0; i < 200; ++i) {
    camera.step(held(i % 7 ? 1 : 0, i % 3 - 1, i % 5 ? 0.7 : -1, 0.3), kStep);
    log.add(camera.pose());
    driven.push_back(camera.pose().world_from_camera());
  }
  const Scenario read = load_mission_text(log.mission("a drive"), "leg.lua").scenario;
  EXPECT_EQ(scenario_to_json(read), scenario_to_json(log.scenario()));
  const std::vector<CameraPose> flown = sample_trajectory(read.trajectory, read.start_ns);
  const CameraPath path(read.trajectory);
  ASSERT_EQ(flown.size(), driven.size());
  for (std::size_t i = 0; i < flown.size(); ++i) {
    EXPECT_EQ(flown[i].stamp_ns, log.stamp_ns(int(i)));
    EXPECT_TRUE(flown[i].world_from_camera.rotation == driven[i].rotation) << i;
    EXPECT_TRUE(flown[i].world_from_camera.translation == driven[i].translation) << i;
    const double t = double(flown[i].stamp_ns - read.start_ns) * 1e-9;
    EXPECT_TRUE(path.motion_at(t).velocity == log.velocity(int(i))) << i;
  }
}

// Frames are rare, steps are not: every fourth has one, with the poses that were seen there.
TEST(DriveLog, StepsBetweenFramesAreInTheMissionToo) {
  for (const double rate : {1.0, 0.7}) {
    Scenario scenario = settle_text(kWall).mission.scenario;
    scenario.trajectory.rate_hz = rate;
    adapt_to_driving(scenario);
    for (const int steps : {1, 5, 8, 42}) {
      DriveLog log(scenario, 4);
      std::vector<Pose> driven;
      for (int i = 0; i < steps; ++i) {
        const DrivenPose pose{{0.1 * i, 0.3 * (i % 3), 1}, {0, 0, 7.0 * i}};
        log.add(pose);
        EXPECT_EQ(log.at_frame(), i % 4 == 0);
        if (log.at_frame()) driven.push_back(pose.world_from_camera());
      }
      EXPECT_EQ(log.frames(), int(driven.size()));
      const TrajectorySpec spec = load_mission_text(log.mission("a drive"), "leg.lua").scenario.trajectory;
      EXPECT_EQ(spec.rate_hz, rate);
      EXPECT_EQ(spec.waypoints.size(), std::size_t(steps) + 1);
      const std::vector<CameraPose> flown = sample_trajectory(spec, scenario.start_ns);
      const CameraPath path(spec);
      ASSERT_EQ(flown.size(), driven.size()) << steps;
      for (std::size_t i = 0; i < flown.size(); ++i) {
        EXPECT_EQ(flown[i].stamp_ns, log.stamp_ns(int(i)));
        EXPECT_TRUE(flown[i].world_from_camera.rotation == driven[i].rotation) << i;
        EXPECT_TRUE(flown[i].world_from_camera.translation == driven[i].translation) << i;
        EXPECT_TRUE(path.motion_at(double(flown[i].stamp_ns - scenario.start_ns) * 1e-9).velocity == log.velocity(int(i))) << i;
      }
    }
  }
}

}  // namespace drive_motion_test
}  // namespace rubble::testing
