// What a navigation program makes of an inertial unit: from the true start, turn by the rates and add
// up the forces, by the trapezoid of two neighbouring samples.
#pragma once

#include <algorithm>
#include <cmath>

#include "scripting/trajectory/imu.h"

namespace rubble {

struct DeadReckoning {
  double worst = 0;    // distance from the true position over the time; unit: m
  double at = 0;       // when; unit: s
  double seconds = 0;  // that were integrated
};

// Noise-free, at `rate_hz`, for at most `most_seconds`.
inline DeadReckoning reckon(const MotionPath& path, double rate_hz = 200, double most_seconds = 10) {
  constexpr double kGravity = 9.81;
  ImuModel model;
  model.rate_hz = rate_hz;
  model.gyroscope_noise = model.gyroscope_walk = 0;
  model.accelerometer_noise = model.accelerometer_walk = 0;
  DeadReckoning result;
  result.seconds = std::min(path.duration(), most_seconds);
  Imu imu(path, model, kGravity, 1, 0);
  const auto samples = imu.take_until(std::int64_t(result.seconds * 1e9));
  CameraMotion state = path.motion_at(0);
  const double h = 1 / rate_hz;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const Vec3 rate = (samples[i].angular_velocity + samples[i + 1].angular_velocity) * (0.5 * h);
    const double angle = norm(rate), half = 0.5 * angle;
    const double scale = angle > 1e-12 ? std::sin(half) / angle : 0.5;
    Quat& q = state.world_from_camera.rotation;
    const Quat next =
        normalized(q * Quat{std::cos(half), rate.x * scale, rate.y * scale, rate.z * scale});
    const Vec3 force = (q.rotate(samples[i].linear_acceleration) +
                        next.rotate(samples[i + 1].linear_acceleration)) * 0.5;
    const Vec3 a = force - Vec3{0, 0, kGravity};
    state.world_from_camera.translation += state.velocity * h + a * (0.5 * h * h);
    state.velocity += a * h;
    q = next;
    const double t = double(i + 1) * h;
    const double error = distance(state.world_from_camera.translation, path.at(t).translation);
    if (error > result.worst) result.worst = error, result.at = t;
  }
  return result;
}

}  // namespace rubble
