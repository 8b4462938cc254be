// The inertial unit against closed forms, finite differences and dead reckoning.
#include "scripting/trajectory/imu.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace imu_test {

constexpr double kGravity = 9.81;

ImuModel without_noise(double rate_hz) { return {rate_hz, 0, 0, 0, 0}; }

Waypoint at(double t, const Vec3& position) {
  Waypoint w;
  w.t = t;
  w.position = position;
  return w;
}

TrajectorySpec path_of(std::vector<Waypoint> waypoints) {
  TrajectorySpec spec;
  spec.waypoints = std::move(waypoints);
  return spec;
}

std::vector<ImuSample> record(const TrajectorySpec& spec, const ImuModel& model,
                              std::uint64_t seed = 1) {
  const CameraPath path(spec);
  Imu imu(path, model, kGravity, seed, 1'000'000'000);
  return imu.take_until(1'000'000'000 + std::llround(path.duration() * 1e9));
}

void expect_near(const Vec3& found, const Vec3& expected, double tolerance, const char* what,
                 double t) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(found[i], expected[i], tolerance) << what << "[" << i << "] at " << t << " s";
}

TEST(Imu, AtRestMeasuresGravityAlone) {
  Waypoint level = at(0, {1, 2, 3}), later = at(1, {1, 2, 3});
  for (const ImuSample& s : record(path_of({level, later}), without_noise(100))) {
    expect_near(s.linear_acceleration, {0, 0, kGravity}, 1e-12, "force", 0);
    expect_near(s.angular_velocity, {0, 0, 0}, 1e-12, "rate", 0);
  }
  level.rpy_deg = later.rpy_deg = {0, 90, 0};  // nose down: X points at the ground
  expect_near(record(path_of({level, later}), without_noise(100))[3].linear_acceleration,
              {-kGravity, 0, 0}, 1e-12, "force", 0);
}

std::vector<ImuSample> record_at(const Pose& rig_from_imu, const TrajectorySpec& spec) {
  const CameraPath path(spec);
  Imu imu(path, without_noise(100), kGravity, 1, 0, rig_from_imu);
  return imu.take_until(std::llround(path.duration() * 1e9));
}

// A rig that stands and turns at a constant rate w: a unit at the radius r feels w^2 r inwards.
TEST(ImuOnALeverArm, FeelsTheCentripetalAcceleration) {
  std::vector<Waypoint> waypoints;
  for (int i = 0; i <= 10; ++i) {
    waypoints.push_back(at(0.5 * i, {1, 2, 3}));
    waypoints.back().rpy_deg = {0, 0, 20.0 * i};
  }
  const double w = 40 * portable::kPi / 180, r = 0.5;
  const auto samples = record_at({{}, {0, r, 0.2}}, path_of(waypoints));
  for (std::size_t i = 150; i < 350; ++i) {
    expect_near(samples[i].angular_velocity, {0, 0, w}, 1e-9, "rate", 0.01 * double(i));
    expect_near(samples[i].linear_acceleration, {0, -w * w * r, kGravity}, 1e-6, "force",
                0.01 * double(i));
  }
}

// On any smooth path: the force is that of the second difference of where the unit itself is, seen in
// its own axes, and the rate that of the rig, likewise.
TEST(ImuOnALeverArm, FeelsTheMotionOfItsOwnPlace) {
  std::vector<Waypoint> waypoints;
  const Vec3 turns[] = {{0, 0, 0}, {10, 20, 60}, {-15, 5, 100}, {0, -20, 170}, {5, 0, 200}};
  for (int i = 0; i < 5; ++i) {
    waypoints.push_back(at(0.8 * i, {0.3 * i, 0.1 * i * i, 1 - 0.05 * i}));
    waypoints.back().rpy_deg = turns[i];
  }
  TrajectorySpec spec = path_of(waypoints);
  spec.smoothing = 0.2;
  const Pose rig_from_imu{portable::quat_from_rpy(0.3, -0.2, 1.1), {0.2, -0.4, 0.1}};
  const CameraPath path(spec);
  const auto place = [&](double t) { return (path.at(t) * rig_from_imu).translation; };
  const auto samples = record_at(rig_from_imu, spec);
  double lever = 0;
  for (std::size_t i = 30; i + 30 < samples.size(); i += 7) {
    const double t = 0.01 * double(i), h = 2e-3;
    const Vec3 a = (place(t + h) - place(t) * 2.0 + place(t - h)) * (1 / (h * h));
    const Quat imu_from_world = (path.at(t) * rig_from_imu).rotation.conjugate();
    expect_near(samples[i].linear_acceleration, imu_from_world.rotate(a + Vec3{0, 0, kGravity}), 0.02,
                "force", t);
    const CameraMotion rig = path.motion_at(t);
    expect_near(rig_from_imu.rotation.rotate(samples[i].angular_velocity), rig.angular_velocity, 1e-9,
                "rate", t);
    lever = std::max(lever, norm(a - rig.acceleration));
  }
  EXPECT_GT(lever, 0.5) << "without the lever arm the forces would be much the same";
}

// The curve through knots of a parabola is that parabola, but for the first and the last leg.
TEST(Imu, ConstantAccelerationIsMeasuredExactly) {
  const Vec3 velocity{0.3, -0.2, 0.1}, acceleration{0.5, 1.5, -0.25};
  std::vector<Waypoint> waypoints;
  for (const double t : {0.0, 0.7, 1.1, 2.0, 2.4, 3.0})
    waypoints.push_back(at(t, velocity * t + acceleration * (0.5 * t * t)));
  const CameraPath path(path_of(waypoints));
  for (const double t : {0.7, 0.9, 1.5, 2.0, 2.39}) {
    const CameraMotion motion = path.motion_at(t);
    expect_near(motion.velocity, velocity + acceleration * t, 1e-12, "velocity", t);
    expect_near(motion.acceleration, acceleration, 1e-11, "acceleration", t);
  }
}

// Round a circle, facing along it: the centre is to the left.
TEST(Imu, ACircleGivesTheCentripetalForceAndTheRateOfTurn) {
  constexpr double kRadius = 2, kTurn = 0.8;  // unit: m, rad/s
  std::vector<Waypoint> waypoints;
  for (int i = 0; i <= 600; ++i) {  // a spline of n knots has its acceleration to 1 / n
    const double t = 0.01 * i, angle = kTurn * t;
    Waypoint w = at(t, {kRadius * std::cos(angle), kRadius * std::sin(angle), 1});
    w.rpy_deg = {0, 0, 90 + angle * 180 / portable::kPi};
    waypoints.push_back(w);
  }
  for (const ImuSample& s : record(path_of(waypoints), without_noise(130))) {
    const double t = double(s.stamp_ns - 1'000'000'000) * 1e-9;
    if (t < 0.1 || t > 5.9) continue;
    expect_near(s.angular_velocity, {0, 0, kTurn}, 1e-9, "rate", t);
    expect_near(s.linear_acceleration, {0, kRadius * kTurn * kTurn, kGravity}, 0.012, "force", t);
  }
}

std::vector<TrajectorySpec> winding_paths() {
  std::vector<TrajectorySpec> specs;
  for (const Interpolation how : {Interpolation::spline, Interpolation::linear}) {
    for (const bool looking : {false, true}) {
      std::vector<Waypoint> waypoints{at(0, {-3, 0, 1}), at(1.1, {-1, 1.5, 2}), at(1.9, {1, 2, 1}),
                                      at(3.2, {2, -1, 1.5})};
      const Vec3 angles[] = {{5, 10, 20}, {-20, -15, 100}, {10, 30, 170}, {0, 0, 260}};
      for (std::size_t i = 0; i < waypoints.size(); ++i) {
        waypoints[i].rpy_deg = looking ? Vec3{angles[i].x, 0, 0} : angles[i];
        if (looking) waypoints[i].look_at = Vec3{0.1 * double(i), 0.3, -0.4};
      }
      specs.push_back(path_of(waypoints));
      specs.back().interpolation = how;
    }
  }
  return specs;
}

TEST(CameraMotion, AgreesWithFiniteDifferencesOfThePath) {
  constexpr double kStep = 1e-5;
  for (const TrajectorySpec& spec : winding_paths()) {
    const CameraPath path(spec);
    for (const double t : {0.05, 0.4, 0.9, 1.3, 1.85, 2.5, 3.1}) {
      const CameraMotion motion = path.motion_at(t);
      const Pose before = path.at(t - kStep), after = path.at(t + kStep);
      expect_near(motion.velocity, (after.translation - before.translation) * (0.5 / kStep), 1e-7,
                  "velocity", t);
      expect_near(
          motion.acceleration,
          (path.motion_at(t + kStep).velocity - path.motion_at(t - kStep).velocity) * (0.5 / kStep),
          1e-6, "acceleration", t);
      const Quat turn = before.rotation.conjugate() * after.rotation;
      const double sign = turn.w < 0 ? -1 : 1;
      expect_near(motion.angular_velocity, Vec3{turn.x, turn.y, turn.z} * (sign / kStep), 1e-6,
                  "rate", t);
      EXPECT_EQ(motion.world_from_camera.rotation, path.at(t).rotation);
    }
  }
}

// What a navigation program does: turn by the rates, add up the forces. The end is the path's; what
// is left comes from steps in which the acceleration jumps, at waypoints.
TEST(Imu, DeadReckoningLeadsToTheEndOfThePath) {
  const TrajectorySpec spec = winding_paths()[0];
  const CameraPath path(spec);
  constexpr double kRate = 2000;
  CameraMotion state = path.motion_at(0);
  const auto samples = record(spec, without_noise(kRate));
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const Vec3 rate = (samples[i].angular_velocity + samples[i + 1].angular_velocity) * 0.5;
    const Vec3 force = (samples[i].linear_acceleration + samples[i + 1].linear_acceleration) * 0.5;
    const double h = 1 / kRate;
    Quat& q = state.world_from_camera.rotation;
    const Quat half = normalized(q * Quat{1, rate.x * h / 4, rate.y * h / 4, rate.z * h / 4});
    const Vec3 a = half.rotate(force) - Vec3{0, 0, kGravity};
    state.world_from_camera.translation += state.velocity * h + a * (0.5 * h * h);
    state.velocity += a * h;
    q = normalized(q * Quat{1, rate.x * h / 2, rate.y * h / 2, rate.z * h / 2});
  }
  const Pose end = path.at(double(samples.size() - 1) / kRate);
  EXPECT_LT(distance(state.world_from_camera.translation, end.translation), 6e-3);
  const Quat error = end.rotation.conjugate() * state.world_from_camera.rotation;
  EXPECT_LT(std::hypot(error.x, error.y, error.z), 1e-4);
}

TEST(Imu, NoiseHasTheStatedDensityAndTheBiasesWalk) {
  ImuModel model;
  model.rate_hz = 100;
  const auto samples = record(path_of({at(0, {}), at(200, {})}), model);
  ASSERT_EQ(samples.size(), 20001u);
  double sum = 0, squares = 0;
  for (const ImuSample& s : samples) {
    const double noise = s.angular_velocity.y - s.angular_bias.y;
    sum += noise;
    squares += noise * noise;
  }
  const double n = double(samples.size()), sigma = model.gyroscope_noise * 10;
  EXPECT_NEAR(std::sqrt(squares / n), sigma, 0.03 * sigma);
  EXPECT_NEAR(sum / n, 0, 4 * sigma / std::sqrt(n));

  double bias_squares = 0;
  constexpr int kSeeds = 300;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Vec3 b = record(path_of({at(0, {}), at(4, {})}), model, std::uint64_t(seed))
                       .back()
                       .acceleration_bias;
    bias_squares += dot(b, b) / 3;
  }
  const double walked = model.accelerometer_walk * std::sqrt(4.0);
  EXPECT_NEAR(std::sqrt(bias_squares / kSeeds), walked, 0.1 * walked);
}

TEST(Imu, IsTheSameForTheSameSeedHoweverItIsAsked) {
  const TrajectorySpec spec = winding_paths()[1];
  const CameraPath path(spec);
  const auto whole = record(spec, {}, 3), other = record(spec, {}, 4);
  Imu imu(path, {}, kGravity, 3, 1'000'000'000);
  std::vector<ImuSample> pieces;
  for (std::int64_t stamp = 1'000'000'000; stamp < 4'200'000'001; stamp += 33'333'333)
    for (const ImuSample& s : imu.take_until(stamp)) pieces.push_back(s);
  ASSERT_LE(pieces.size(), whole.size());
  ASSERT_GT(pieces.size(), 600u);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].stamp_ns, whole[i].stamp_ns);
    EXPECT_EQ(pieces[i].angular_velocity, whole[i].angular_velocity);
    EXPECT_EQ(pieces[i].linear_acceleration, whole[i].linear_acceleration);
  }
  EXPECT_FALSE(whole[5].angular_velocity == other[5].angular_velocity);
}

}  // namespace imu_test
}  // namespace rubble
