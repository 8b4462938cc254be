// Limits on speed, acceleration and turning, against what the flown path does between its frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/scripting/test_support.h"

namespace rubble {
namespace time_scale_test {

constexpr double kDegree = 3.14159265358979323846 / 180;

struct Extremes {
  double speed = 0, acceleration = 0, turn_rate_deg = 0;
};

// By differences over `h`.
Extremes measure(const CameraPath& t, double h = 0.02) {
  Extremes e;
  for (double s = h; s + h < t.duration(); s += h / 2) {
    const Pose a = t.at(s - h), b = t.at(s), c = t.at(s + h);
    const Vec3 before = (b.translation - a.translation) * (1 / h);
    const Vec3 after = (c.translation - b.translation) * (1 / h);
    e.speed = std::max(e.speed, norm(after));
    e.acceleration = std::max(e.acceleration, norm(after - before) / h);
    const Quat d = b.rotation.conjugate() * c.rotation;
    e.turn_rate_deg = std::max(
        e.turn_rate_deg, 2 * std::asin(std::min(1.0, norm(Vec3{d.x, d.y, d.z}))) / kDegree / h);
  }
  return e;
}

TrajectorySpec hairpin() {
  return load_text("return { trajectory = { waypoints = { { position = {0, 0, 1} }, "
                   "{ t = 1, position = {4, 0, 1} }, { t = 2, position = {4.5, 1, 1}, rpy_deg = {0, 0, 180} }, "
                   "{ t = 3, position = {0, 1.5, 1.5}, rpy_deg = {0, 0, 180} } } } }")
      .scenario.trajectory;
}

TEST(Limits, AreExceededWithoutThem) {
  const Extremes e = measure(CameraPath(hairpin()));
  EXPECT_GT(e.speed, 4);
  EXPECT_GT(e.acceleration, 5);
  EXPECT_GT(e.turn_rate_deg, 180);
}

TEST(Limits, EachIsKept) {
  TrajectorySpec spec = hairpin();
  spec.limits.max_speed = 1.5;
  EXPECT_LT(measure(CameraPath(spec)).speed, 1.5 * 1.001);
  spec = hairpin();
  spec.limits.max_turn_rate_deg = 60;
  EXPECT_LT(measure(CameraPath(spec)).turn_rate_deg, 60 * 1.001);
  spec = hairpin();
  spec.limits.max_acceleration = 2;
  EXPECT_LT(measure(CameraPath(spec)).acceleration, 2 * 1.1);
}

// It takes the camera 2 ms to turn round: less than an entry of the table of times.
TEST(Limits, ATurnThatIsAskedForWithinMillisecondsIsKept) {
  TrajectorySpec spec =
      load_text("return { trajectory = { rate_hz = 10, interpolation = 'linear', waypoints = { { position = {0, 0, 1} }, "
                "{ t = 2, position = {1, 0, 1} }, { t = 2.002, position = {1.001, 0, 1}, rpy_deg = {0, 0, 179} }, "
                "{ t = 4, position = {2, 0, 1}, rpy_deg = {0, 0, 179} } } } }")
          .scenario.trajectory;
  EXPECT_GT(measure(CameraPath(spec), 0.001).turn_rate_deg, 1e4);
  spec.limits.max_turn_rate_deg = 90;
  EXPECT_LT(measure(CameraPath(spec), 0.001).turn_rate_deg, 91);
}

// Corners of the path and entries of the table that are the same but for rounding.
TEST(Limits, AFastTurnAtTheEndOfAnyDurationHasAnEnd) {
  for (int i = 1; i <= 300; ++i) {
    TrajectorySpec spec = hairpin();
    spec.interpolation = Interpolation::linear;
    spec.waypoints.back().rpy_deg = {0, 0, 0};
    spec.duration = 0.1 + i / 37.0;
    spec.limits.max_turn_rate_deg = 45;
    const CameraPath path(spec);
    for (const double t : {path.duration(), path.duration() - 1e-9}) {
      const Pose end = path.at(t);
      EXPECT_LT(distance(end.translation, spec.waypoints.back().position), 1e-6) << i;
      EXPECT_GT(std::abs(end.rotation.w), 1 - 1e-6) << i;
    }
  }
}

TEST(Limits, AllAtOnceOnTheSamePath) {
  TrajectorySpec spec = hairpin();
  const CameraPath free(spec);
  spec.limits = {1.0, 1.0, 45};
  const CameraPath limited(spec);
  EXPECT_GT(limited.duration(), 2 * free.duration());
  EXPECT_EQ(limited.asked_duration(), free.duration());
  const Extremes e = measure(limited);
  EXPECT_LT(e.speed, 1.001);
  EXPECT_LT(e.acceleration, 1.1);
  EXPECT_LT(e.turn_rate_deg, 45.1);
  // Every place of it lies on the free path.
  for (double t = 0; t < limited.duration(); t += 0.37) {
    double nearest = 1e9;
    for (double s = 0; s <= free.duration(); s += 0.001)
      nearest = std::min(nearest, distance(free.at(s).translation, limited.at(t).translation));
    EXPECT_LT(nearest, 0.005) << t;
  }
}

TEST(Limits, OnAStraightLineTheTimeIsTheClosedForm) {
  // 4 m asked in 1 s, from a moving start: at most 2 m/s takes 2 s.
  TrajectorySpec spec = load_text("return { trajectory = { interpolation = 'linear', waypoints = { "
                                  "{ position = {0, 0, 1} }, { t = 1, position = {4, 0, 1} } } } }")
                            .scenario.trajectory;
  spec.limits.max_speed = 2;
  EXPECT_NEAR(CameraPath(spec).duration(), 2, 1e-9);
  EXPECT_NEAR(CameraPath(spec).at(1).translation.x, 2, 1e-6);
}

TEST(Limits, WhatIsSlowEnoughKeepsItsTimes) {
  TrajectorySpec spec = hairpin();
  const CameraPath free(spec);
  spec.limits = {100.0, 10000.0, 30000};
  const CameraPath limited(spec);
  EXPECT_NEAR(limited.duration(), free.duration(), 1e-9);
  EXPECT_NEAR(distance(limited.at(1.7).translation, free.at(1.7).translation), 0, 1e-6);
}

// What an inertial unit on the camera feels, against differences of the poses.
TEST(Limits, MotionIsThatOfTheSlowedPath) {
  TrajectorySpec spec = hairpin();
  spec.limits = {1.0, 1.5, 60};
  spec.duration = 4;
  const CameraPath path(spec);
  const double h = 1e-5;
  for (double t = 0.31; t < path.duration() - 0.3; t += 0.173) {
    const CameraMotion motion = path.motion_at(t);
    const Pose before = path.at(t - h), after = path.at(t + h);
    const Vec3 velocity = (after.translation - before.translation) * (0.5 / h);
    EXPECT_NEAR(distance(motion.velocity, velocity), 0, 1e-5) << t;
    const Quat d = before.rotation.conjugate() * after.rotation;
    EXPECT_NEAR(distance(motion.angular_velocity, Vec3{d.x, d.y, d.z} * (1 / h)), 0, 1e-4) << t;
    const Vec3 acceleration =
        (path.motion_at(t + h).velocity - path.motion_at(t - h).velocity) * (0.5 / h);
    EXPECT_NEAR(distance(motion.acceleration, acceleration), 0, 0.02) << t;
  }
}

TEST(Limits, APauseStaysAPause) {
  TrajectorySpec spec =
      load_text("return { trajectory = { max_speed = 1, waypoints = { { position = {0, 0, 1} }, "
                "{ t = 1, position = {2, 0, 1} }, { t = 3, position = {2, 0, 1} }, { t = 4, position = {4, 0, 1} } } } }")
          .scenario.trajectory;
  // 2 s more of standing still than the two ways of 2 m at 1 m/s, with their spline's slow ends.
  EXPECT_GT(CameraPath(spec).duration(), 6);
  EXPECT_LT(CameraPath(spec).duration(), 7.2);
}

}  // namespace time_scale_test
}  // namespace rubble
