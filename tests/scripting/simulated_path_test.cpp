// Paths of simulated bodies, and what an inertial unit on one feels.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/portable_math.h"
#include "scripting/trajectory/curves.h"
#include "scripting/trajectory/simulated_path.h"
#include "tests/scripting/dead_reckoning.h"

namespace rubble {
namespace simulated_path_test {

constexpr double kStep = 1.0 / 240, kGravity = 9.81;

// A body that tumbles, falls by symplectic Euler steps and bounces off the ground with half its speed.
std::vector<Pose> bounce(int steps, const Vec3& turning = {1.5, -2, 4}) {
  std::vector<Pose> poses;
  Pose at{portable::quat_from_rpy(0.3, -0.4, 2), {0, 0, 0.8}};
  Vec3 velocity{1, 0.5, 0}, spin = turning;
  for (int i = 0; i <= steps; ++i) {
    poses.push_back(at);
    velocity.z -= kGravity * kStep;
    if (at.translation.z < 0 && velocity.z < 0) velocity.z *= -0.5, spin = spin * -0.7;
    at.translation += velocity * kStep;
    at.rotation = normalized(rotation_by(spin * kStep) * at.rotation);
  }
  return poses;
}

ImuModel without_noise(double rate_hz) {
  ImuModel model;
  model.rate_hz = rate_hz;
  model.gyroscope_noise = model.gyroscope_walk = 0;
  model.accelerometer_noise = model.accelerometer_walk = 0;
  return model;
}

TEST(SimulatedPath, PassesThroughEveryStepAndIsContinuous) {
  const std::vector<Pose> poses = bounce(400);
  const SimulatedPath path(poses, kStep);
  EXPECT_NEAR(path.duration(), 400 * kStep, 1e-12);
  for (int i = 1; i < 400; ++i) {
    const double t = i * kStep;
    EXPECT_LT(distance(path.at(t).translation, poses[std::size_t(i)].translation), 1e-12);
    const CameraMotion before = path.motion_at(t - 1e-9), after = path.motion_at(t + 1e-9);
    EXPECT_LT(norm(after.velocity - before.velocity), 1e-5) << "at step " << i;
    EXPECT_LT(norm(after.angular_velocity - before.angular_velocity), 1e-5) << "at step " << i;
  }
  EXPECT_TRUE(path.at(-1).translation == poses.front().translation);
  EXPECT_TRUE(path.at(99).translation == poses.back().translation);
}

// Its derivatives are those of its poses.
TEST(SimulatedPath, MotionIsTheDerivativeOfThePoses) {
  const SimulatedPath path(bounce(300), kStep);
  const double h = 1e-6;
  for (double t = 0.0123; t < 1.2; t += 0.0137) {
    const CameraMotion motion = path.motion_at(t);
    const Pose from = path.at(t - h), to = path.at(t + h);
    const Vec3 velocity = (to.translation - from.translation) * (0.5 / h);
    const Vec3 turning = rotation_vector(from.rotation.conjugate() * to.rotation) * (0.5 / h);
    EXPECT_LT(norm(velocity - motion.velocity), 1e-5) << t;
    EXPECT_LT(norm(turning - motion.angular_velocity), 1e-5) << t;
  }
}

TEST(ImuOnASimulatedBody, FeelsNothingInFreeFall) {
  const SimulatedPath path(bounce(80, {}), kStep);  // not yet at the ground
  Imu imu(path, without_noise(200), kGravity, 1, 0);
  const auto samples = imu.take_until(300'000'000);
  ASSERT_GT(samples.size(), 50u);
  for (std::size_t i = 2; i < samples.size(); ++i)
    EXPECT_LT(norm(samples[i].linear_acceleration), 1e-9) << i;
}

// Through impacts of 3 m/s and at any rate, what is integrated from it is the way of the unit itself.
TEST(ImuOnASimulatedBody, IntegratedFollowsTheTruePose) {
  const std::vector<Pose> poses = bounce(1200);
  const SimulatedPath path(poses, kStep);
  for (const double rate : {100.0, 200.0, 400.0}) {
    const DeadReckoning found = reckon(path, rate, 5);
    EXPECT_GT(found.seconds, 4.9);
    EXPECT_LT(found.worst, rate > 150 ? 0.02 : 0.08) << rate << " Hz, at " << found.at << " s";
  }
}

// A robot begins at rest: so does what is integrated, and the first reading has the whole jerk of the start.
TEST(ImuOnASimulatedBody, FeelsTheStart) {
  SimulatedPath path(kStep);
  for (int i = 0; i <= 240; ++i) path.add({{}, {0.5 * 3 * (i * kStep) * ((i + 1) * kStep), 0, 0}});  // 3 m/s2 by symplectic steps
  EXPECT_TRUE(path.motion_at(0).velocity == Vec3());
  for (const double rate : {100.0, 200.0, 400.0}) {
    Imu imu(path, without_noise(rate), kGravity, 1, 0);
    double speed = 0;
    Vec3 before = imu.take().linear_acceleration;
    EXPECT_GT(before.x, 2.9);
    for (int i = 1; i <= int(rate / 2); ++i) {
      const Vec3 felt = imu.take().linear_acceleration;
      speed += 0.5 * (before.x + felt.x) / rate, before = felt;
    }
    EXPECT_NEAR(speed, 1.5, 0.015) << rate;
  }
}

// The unit at a lever arm feels what a unit feels whose own poses were simulated.
TEST(ImuOnASimulatedBody, LeverArmIsThatOfItsOwnPlace) {
  const Pose body_from_imu{portable::quat_from_rpy(0.5, 0.1, -1), {0.3, -0.2, 0.4}};
  const SimulatedPath body(bounce(600), kStep);
  std::vector<Pose> own;
  for (const Pose& pose : bounce(600)) own.push_back(pose * body_from_imu);
  const SimulatedPath place(own, kStep);
  Imu on_arm(body, without_noise(120), kGravity, 1, 0, body_from_imu);
  Imu there(place, without_noise(120), kGravity, 1, 0);
  const auto a = on_arm.take_until(2'400'000'000), b = there.take_until(2'400'000'000);
  double felt = 0;
  for (std::size_t i = 3; i + 3 < a.size(); ++i) {
    EXPECT_LT(norm(a[i].angular_velocity - b[i].angular_velocity), 1e-6) << i;
    EXPECT_LT(norm(a[i].linear_acceleration - b[i].linear_acceleration), 1) << i;  // 1 % of an impact
    felt = std::max(felt, norm(a[i].linear_acceleration));
  }
  EXPECT_GT(felt, 100) << "the impacts were to be felt";
}

// The negative control: readings at instants miss impacts between them, and drift.
class AtInstants : public SimulatedPath {
 public:
  using SimulatedPath::SimulatedPath;
  bool is_simulated() const override { return false; }
};

TEST(ImuOnASimulatedBody, ReadingsAtInstantsWouldNot) {
  const AtInstants path(bounce(1200), kStep);
  EXPECT_GT(reckon(path, 100, 5).worst, 0.2);
}

}  // namespace simulated_path_test
}  // namespace rubble
