#include "scripting/trajectory/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernel/base/portable_math.h"
#include "tests/scripting/test_support.h"

namespace rubble {
namespace trajectory_test {

constexpr std::int64_t kEpoch = 1'000'000'000;

Waypoint at(double t, Vec3 position, Vec3 rpy_deg = {}) {
  Waypoint w;
  w.t = t;
  w.position = position;
  w.rpy_deg = rpy_deg;
  return w;
}

Waypoint looking(double t, Vec3 position, Vec3 target, double roll_deg = 0) {
  Waypoint w = at(t, position, {roll_deg, 0, 0});
  w.look_at = target;
  return w;
}

TrajectorySpec spec_of(std::vector<Waypoint> waypoints) {
  TrajectorySpec spec;
  spec.waypoints = std::move(waypoints);
  return spec;
}

double angle_between(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2 * std::atan2(norm(Vec3{d.x, d.y, d.z}), std::abs(d.w));
}

Quat rpy(const Vec3& deg) {
  const double k = M_PI / 180;
  return portable::quat_from_rpy(deg.x * k, deg.y * k, deg.z * k);
}

TEST(Trajectory, OneWaypointIsOneFrame) {
  const auto poses = sample_trajectory(spec_of({at(0, {1, 2, 3}, {0, 90, 0})}), kEpoch);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].stamp_ns, kEpoch);
  EXPECT_EQ(poses[0].world_from_camera.translation, Vec3(1, 2, 3));
  // Positive pitch looks down.
  EXPECT_LT(distance(poses[0].world_from_camera.rotation.rotate({1, 0, 0}), Vec3(0, 0, -1)), 1e-12);
}

TEST(Trajectory, PassesThroughItsWaypoints) {
  const std::vector<Waypoint> way = {at(0, {0, 0, 0}, {0, 0, 0}), at(1, {1, 2, 0}, {10, 20, 100}),
                                     at(1.5, {4, 2, 1}, {-30, 10, 170}),
                                     at(3, {4, -5, 2}, {0, -40, -120})};
  for (const Interpolation how : {Interpolation::spline, Interpolation::linear}) {
    TrajectorySpec spec = spec_of(way);
    spec.interpolation = how;
    const auto poses = sample_trajectory(spec, kEpoch);
    ASSERT_EQ(poses.size(), 91u);
    for (const Waypoint& w : way) {
      const Pose& pose = poses[std::size_t(std::lround(*w.t * 30))].world_from_camera;
      EXPECT_LT(distance(pose.translation, w.position), 1e-12);
      EXPECT_LT(angle_between(pose.rotation, rpy(w.rpy_deg)), 1e-9);
    }
  }
}

TEST(Trajectory, ConstantSpeedOnAStraightLine) {
  for (const Interpolation how : {Interpolation::spline, Interpolation::linear}) {
    TrajectorySpec spec = spec_of({at(0, {0, 0, 0}), {}, {}});
    spec.interpolation = how;
    spec.speed = 0.6;
    spec.waypoints[1].position = {0.9, 1.2, 0};  // 1.5 m: 2.5 s
    spec.waypoints[2].position = {1.2, 1.6, 0};  // 0.5 m more: 1 s at its own speed
    spec.waypoints[2].speed = 0.6;
    const auto poses = sample_trajectory(spec, kEpoch);
    ASSERT_EQ(poses.size(), 101u);  // 2.0 m at 0.6 m/s: 3.33 s
    for (std::size_t k = 0; k < poses.size(); ++k)
      EXPECT_LT(distance(poses[k].world_from_camera.translation,
                         Vec3(0.6, 0.8, 0) * (0.6 * double(k) / 30)),
                1e-12)
          << k;
  }
}

TEST(Trajectory, ConstantTurnAboutOneAxis) {
  for (const Interpolation how : {Interpolation::spline, Interpolation::linear}) {
    TrajectorySpec spec =
        spec_of({at(0, {0, 0, 1}), at(1, {0, 0, 1}, {0, 0, 60}), at(3, {0, 0, 1}, {0, 0, 180})});
    spec.interpolation = how;
    const auto poses = sample_trajectory(spec, kEpoch);
    for (std::size_t k = 0; k < poses.size(); ++k)
      EXPECT_LT(angle_between(poses[k].world_from_camera.rotation, rpy({0, 0, 2.0 * double(k)})),
                1e-9)
          << k;
  }
}

// No jump in velocity, straight or turning, at a waypoint. The linear motion is the control.
TEST(Trajectory, SplineIsSmoothWhereLinearIsNot) {
  TrajectorySpec spec = spec_of({at(0, {0, 0, 0}), at(1, {1, 0, 0}, {0, 0, 50}),
                                 at(2, {1, 1, 0}, {0, 40, 50}), at(3, {0, 1, 0})});
  spec.rate_hz = 1000;
  const auto largest_jump = [&](Interpolation how, double& turn_jump) {
    spec.interpolation = how;
    const auto poses = sample_trajectory(spec, kEpoch);
    double jump = 0;
    turn_jump = 0;
    for (std::size_t k = 1; k + 1 < poses.size(); ++k) {
      const Pose &a = poses[k - 1].world_from_camera, &b = poses[k].world_from_camera,
                 &c = poses[k + 1].world_from_camera;
      jump = std::max(jump, norm(c.translation - 2.0 * b.translation + a.translation) * 1000);
      const Quat ab = a.rotation.conjugate() * b.rotation, bc = b.rotation.conjugate() * c.rotation;
      turn_jump = std::max(turn_jump, 2000 * norm(Vec3{bc.x - ab.x, bc.y - ab.y, bc.z - ab.z}));
    }
    return jump;
  };
  double turn = 0;
  EXPECT_LT(largest_jump(Interpolation::spline, turn), 0.02);  // unit: m/s
  EXPECT_LT(turn, 0.02);                                       // unit: rad/s
  EXPECT_GT(largest_jump(Interpolation::linear, turn), 1.0);
  EXPECT_GT(turn, 0.5);
}

TEST(Trajectory, APauseIsOne) {
  TrajectorySpec spec = spec_of({at(0, {0, 0, 0}), at(1, {1, 0, 0}), at(2, {1, 0, 0}, {0, 0, 90}),
                                 at(3, {2, 1, 0}, {0, 0, 90})});
  const auto poses = sample_trajectory(spec, kEpoch);
  for (std::size_t k = 30; k <= 60; ++k)
    EXPECT_LT(distance(poses[k].world_from_camera.translation, Vec3(1, 0, 0)), 1e-12) << k;
}

TEST(Trajectory, LookAtKeepsTheTargetInTheMiddle) {
  const Vec3 target{1, 2, 0.5};
  const auto poses =
      sample_trajectory(spec_of({looking(0, {-4, 0, 2}, target), looking(1, {0, -4, 3}, target),
                                 looking(2, {5, 1, 1}, target)}),
                        kEpoch);
  for (const CameraPose& pose : poses) {
    const Pose camera_from_world = pose.world_from_camera.inverse();
    const Vec3 seen = camera_from_world * target;
    EXPECT_LT(std::hypot(seen.y, seen.z), 1e-9);
    EXPECT_GT(seen.x, 1);
    // Without roll, the camera's Y axis is level and its Z axis points up.
    EXPECT_NEAR(pose.world_from_camera.rotation.rotate({0, 1, 0}).z, 0, 1e-12);
    EXPECT_GT(pose.world_from_camera.rotation.rotate({0, 0, 1}).z, 0);
  }
}

TEST(Trajectory, LookAtKeepsTheRoll) {
  const auto poses = sample_trajectory(spec_of({looking(0, {-4, 0, 0}, {0, 0, 0}, 30)}), kEpoch);
  const Vec3 left = poses[0].world_from_camera.rotation.rotate({0, 1, 0});
  EXPECT_LT(distance(left, Vec3(0, std::cos(M_PI / 6), 0.5)), 1e-12);
}

TEST(Trajectory, LookingStraightDown) {
  const auto poses = sample_trajectory(spec_of({looking(0, {0, 0, 5}, {0, 0, 0})}), kEpoch);
  EXPECT_LT(distance(poses[0].world_from_camera.rotation.rotate({1, 0, 0}), Vec3(0, 0, -1)), 1e-12);
}

TEST(Trajectory, ViewIsContinuousWhereLookAtEnds) {
  TrajectorySpec spec =
      spec_of({looking(0, {-4, 0, 1}, {0, 0, 0}), looking(1, {-3, 0, 1}, {0, 0, 0}),
               at(2, {-2, 0, 1}, {0, 0, 45}), at(3, {-1, 0, 1}, {0, 0, 90})});
  spec.rate_hz = 1000;
  const auto poses = sample_trajectory(spec, kEpoch);
  for (std::size_t k = 1; k < poses.size(); ++k)
    EXPECT_LT(
        angle_between(poses[k - 1].world_from_camera.rotation, poses[k].world_from_camera.rotation),
        0.005)
        << k;
}

TEST(Trajectory, StampsAreExactAndDoNotDrift) {
  const auto poses = sample_trajectory(spec_of({at(0, {0, 0, 0}), at(3600, {1, 0, 0})}), kEpoch);
  ASSERT_EQ(poses.size(), 108001u);
  EXPECT_EQ(poses[1].stamp_ns, kEpoch + 33'333'333);
  EXPECT_EQ(poses[2].stamp_ns, kEpoch + 66'666'667);
  EXPECT_EQ(poses[3].stamp_ns, kEpoch + 100'000'000);
  for (std::size_t k = 0; k < poses.size(); k += 3)
    ASSERT_EQ(poses[k].stamp_ns, kEpoch + std::int64_t(k) / 3 * 100'000'000);
  TrajectorySpec slow = spec_of({at(0, {0, 0, 0}), at(0.25, {1, 0, 0})});
  slow.rate_hz = 10;
  EXPECT_EQ(sample_trajectory(slow, kEpoch).size(), 3u);  // 0, 0.1, 0.2: the last before the end
}

TEST(Trajectory, UnitQuaternionsAndTheSameBitsAgain) {
  TrajectorySpec spec = spec_of({at(0, {0, 0, 0}, {0, 0, 170}), at(1, {1, 2, 3}, {20, -80, -170}),
                                 at(2, {3, 2, 1}, {180, 10, 0})});
  const auto a = sample_trajectory(spec, kEpoch), b = sample_trajectory(spec, kEpoch);
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Quat& q = a[k].world_from_camera.rotation;
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-14);
    EXPECT_EQ(q, b[k].world_from_camera.rotation);
    EXPECT_EQ(a[k].world_from_camera.translation, b[k].world_from_camera.translation);
  }
}

TEST(TrajectoryErrors, EachInItsWords) {
  const auto error = [](std::vector<Waypoint> waypoints) {
    return error_of([&] { sample_trajectory(spec_of(std::move(waypoints)), kEpoch); });
  };
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error({}),
            "trajectory.waypoints: no waypoint: expected at least one, found an empty list");
  EXPECT_EQ(error({at(0, {0, 0, 0}), at(2, {1, 0, 0}), at(2, {2, 0, 0})}),
            "trajectory.waypoints[3].t: times do not increase: expected a time after 2 s, found 2");
  EXPECT_EQ(error({at(0, {0, inf, 0})}),
            "trajectory.waypoints[1].position: not finite: expected finite numbers");
  EXPECT_EQ(error({at(1, {0, 0, 0})}),
            "trajectory.waypoints[1].t: the first waypoint is the start: expected 0, found 1");
  TrajectorySpec spec;
  spec.rate_hz = 0;
  EXPECT_EQ(error_of([&] { sample_trajectory(spec, kEpoch); }),
            "trajectory.rate_hz: out of range: expected a number above 0, found 0");
  EXPECT_EQ(error({at(0, {0, 0, 0}), at(1e6, {1, 0, 0})}),
            "trajectory: too long: expected at most 10000000 frames, found 30000000");
}

// A limit that is far too small, such as one in km/s: refused before lists of that length are made.
TEST(TrajectoryErrors, APathThatLimitsStretchWithoutEndIsRefused) {
  const auto error_with = [](const auto& change) {
    TrajectorySpec spec = spec_of({at(0, {-4, -4, 2}), at(1, {-2, -4, 2}, {0, 0, 90})});
    change(spec);
    return error_of([&] { sample_trajectory(spec, kEpoch); });
  };
  for (const double least : {1e-7, 1e-30, 1e-300}) {
    EXPECT_NE(error_with([&](auto& s) { s.limits.max_speed = least; }).find("trajectory.max_speed: the path takes too long"), std::string::npos);
    EXPECT_NE(error_with([&](auto& s) { s.limits.max_turn_rate_deg = least; }).find("trajectory.max_turn_rate_deg"), std::string::npos);
    EXPECT_NE(error_with([&](auto& s) { s.limits.max_speed = least, s.smoothing = 0.1; }).find("trajectory.max_speed"), std::string::npos);
  }
  EXPECT_NE(error_with([](auto& s) { s.smoothing = 1e-9; }).find("trajectory.smoothing"), std::string::npos);
  EXPECT_NE(error_with([](auto& s) { s.limits.max_speed = 1e-7; }).find("frames at 30 Hz"), std::string::npos);
  TrajectorySpec slow = spec_of({at(0, {0, 0, 0}), at(1, {1, 0, 0})});
  slow.limits.max_speed = 0.01, slow.rate_hz = 1;
  EXPECT_EQ(sample_trajectory(slow, kEpoch).size(), 101u);
}

TEST(CameraPath, IsTheFramesPathAtAnyTime) {
  TrajectorySpec spec;
  spec.rate_hz = 10;
  spec.waypoints.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    spec.waypoints[i].t = double(i) * 0.5;
    spec.waypoints[i].position = {double(i), double(i * i), 1};
    spec.waypoints[i].look_at = Vec3{0, 9, 0};
  }
  const CameraPath path(spec);
  EXPECT_EQ(path.duration(), 1);
  const std::vector<CameraPose> frames = sample_trajectory(spec, 1);
  for (const int k : {7, 2, 9, 0, 10}) {  // in no order: no call depends on another
    const Pose pose = path.at(k / 10.0), frame = frames[std::size_t(k)].world_from_camera;
    EXPECT_EQ(pose.translation, frame.translation);
    EXPECT_EQ(pose.rotation, frame.rotation);
  }
  EXPECT_EQ(path.at(-1).translation, path.at(0).translation);
  EXPECT_EQ(path.at(2).translation, path.at(1).translation);
  EXPECT_FALSE(path.at(0.55).translation == path.at(0.5).translation);
}

}  // namespace trajectory_test
}  // namespace rubble
