#include "scripting/trajectory/imu.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kDifference = 1e-4;  // half the step of a central difference; unit: s

Vec3 normal_vector(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

}  // namespace

Imu::Imu(const MotionPath& path, const ImuModel& model, double gravity, std::uint64_t seed,
         std::int64_t epoch_ns, const std::optional<Pose>& rig_from_imu)
    : path_(path),
      model_(model),
      gravity_(gravity),
      rig_from_imu_(rig_from_imu),
      epoch_ns_(epoch_ns),
      noise_(seed, "imu/noise"),
      walk_(seed, "imu/walk") {}

ImuSample Imu::sample(std::int64_t index, std::int64_t stamp_ns) {
  const double step = 1.0 / std::sqrt(model_.rate_hz), density = std::sqrt(model_.rate_hz);
  if (index > 0) {
    angular_bias_ += normal_vector(walk_) * (model_.gyroscope_walk * step);
    acceleration_bias_ += normal_vector(walk_) * (model_.accelerometer_walk * step);
  }
  const double t = double(index) / model_.rate_hz;
  const Reading exact = path_.is_simulated() ? read_mean(t) : read_at(t);
  ImuSample s;
  s.stamp_ns = stamp_ns;
  s.angular_bias = angular_bias_;
  s.acceleration_bias = acceleration_bias_;
  s.angular_velocity =
      exact.turn + angular_bias_ + normal_vector(noise_) * (model_.gyroscope_noise * density);
  s.linear_acceleration = exact.felt + acceleration_bias_ +
                          normal_vector(noise_) * (model_.accelerometer_noise * density);
  return s;
}

Imu::Reading Imu::read_at(double t) const {
  const CameraMotion motion = path_.motion_at(t);
  Vec3 acceleration = motion.acceleration;
  if (rig_from_imu_) acceleration += lever_acceleration(t, motion);
  const Vec3 force = acceleration + Vec3{0, 0, gravity_};
  Vec3 turn = motion.angular_velocity;
  Vec3 felt = motion.world_from_camera.rotation.conjugate().rotate(force);
  if (rig_from_imu_) {
    const Quat imu_from_rig = rig_from_imu_->rotation.conjugate();
    turn = imu_from_rig.rotate(turn), felt = imu_from_rig.rotate(felt);
  }
  return {turn, felt};
}

// As units report that integrate within themselves (angle and velocity increments over the period):
//   w = log(R(t0)^T R(t1)) / (t1 - t0),  f = R(half way)^T ((v(t1) - v(t0)) / (t1 - t0) + g z)
Imu::Reading Imu::read_mean(double t) const {
  const double half = 0.5 / model_.rate_hz;
  const double t0 = std::clamp(t - half, 0.0, path_.duration());
  const double t1 = std::clamp(t + half, 0.0, path_.duration());
  const Pose rig_from_imu = rig_from_imu_.value_or(Pose{});
  const CameraMotion from = path_.motion_at(t0), to = path_.motion_at(t1);
  const Quat start = from.world_from_camera.rotation * rig_from_imu.rotation;
  const Quat end = to.world_from_camera.rotation * rig_from_imu.rotation;
  Reading reading;
  Vec3 acceleration;
  const Vec3 turned = rotation_vector(start.conjugate() * end);
  if (t1 > t0) {
    const auto velocity = [&](const CameraMotion& m) {
      return m.velocity +
             m.world_from_camera.rotation.rotate(cross(m.angular_velocity, rig_from_imu.translation));
    };
    reading.turn = turned * (1 / (t1 - t0));
    acceleration = (velocity(to) - velocity(from)) * (1 / (t1 - t0));
  }
  const Quat half_way = start * rotation_by(turned * 0.5);
  reading.felt = half_way.conjugate().rotate(acceleration + Vec3{0, 0, gravity_});
  return reading;
}

// In the world; unit: m/s2. Before its beginning and after its end the path stands still: there the
// difference is one-sided.
Vec3 Imu::lever_acceleration(double t, const CameraMotion& motion) const {
  const double before = std::max(0.0, t - kDifference);
  const double after = std::min(path_.duration(), t + kDifference);
  if (after <= before) return {};
  const Vec3 r = rig_from_imu_->translation, w = motion.angular_velocity;
  const Vec3 dw = (path_.motion_at(after).angular_velocity -
                   path_.motion_at(before).angular_velocity) * (1 / (after - before));
  return motion.world_from_camera.rotation.rotate(cross(dw, r) + cross(w, cross(w, r)));
}

std::int64_t Imu::next_stamp() const {
  return epoch_ns_ + std::int64_t(std::floor(double(next_) * 1e9 / model_.rate_hz + 0.5));
}

ImuSample Imu::take() {
  const std::int64_t stamp_ns = next_stamp();
  return sample(next_++, stamp_ns);
}

std::vector<ImuSample> Imu::take_until(std::int64_t stamp_ns) {
  std::vector<ImuSample> samples;
  while (next_stamp() <= stamp_ns) samples.push_back(take());
  return samples;
}

}  // namespace rubble
