#include "scripting/trajectory/imu.h"

#include <cmath>

namespace rubble {
namespace {

Vec3 normal_vector(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

}  // namespace

Imu::Imu(const CameraPath& path, const ImuModel& model, double gravity, std::uint64_t seed,
         std::int64_t epoch_ns)
    : path_(path),
      model_(model),
      gravity_(gravity),
      epoch_ns_(epoch_ns),
      noise_(seed, "imu/noise"),
      walk_(seed, "imu/walk") {}

ImuSample Imu::sample(std::int64_t index, std::int64_t stamp_ns) {
  const double step = 1.0 / std::sqrt(model_.rate_hz), density = std::sqrt(model_.rate_hz);
  if (index > 0) {
    angular_bias_ += normal_vector(walk_) * (model_.gyroscope_walk * step);
    acceleration_bias_ += normal_vector(walk_) * (model_.accelerometer_walk * step);
  }
  const CameraMotion motion = path_.motion_at(double(index) / model_.rate_hz);
  const Vec3 force = motion.acceleration + Vec3{0, 0, gravity_};
  ImuSample s;
  s.stamp_ns = stamp_ns;
  s.angular_bias = angular_bias_;
  s.acceleration_bias = acceleration_bias_;
  s.angular_velocity = motion.angular_velocity + angular_bias_ +
                       normal_vector(noise_) * (model_.gyroscope_noise * density);
  s.linear_acceleration = motion.world_from_camera.rotation.conjugate().rotate(force) +
                          acceleration_bias_ +
                          normal_vector(noise_) * (model_.accelerometer_noise * density);
  return s;
}

std::vector<ImuSample> Imu::take_until(std::int64_t stamp_ns) {
  std::vector<ImuSample> samples;
  while (true) {
    const auto offset = std::int64_t(std::floor(double(next_) * 1e9 / model_.rate_hz + 0.5));
    if (epoch_ns_ + offset > stamp_ns) return samples;
    samples.push_back(sample(next_++, epoch_ns_ + offset));
  }
}

}  // namespace rubble
