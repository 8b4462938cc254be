// An inertial unit carried along a camera path: what it would measure, from the path's exact
// derivatives.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/base/random.h"
#include "render/scene/frame.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// Sits at a place of its own on the rig that flies the path; without one, in the camera body, with its
// axes (X forward, Y left, Z up).
//
// A sample at time t is
//   angular velocity     w(t) + bias_w + n_w
//   specific force       R(t)^T (a(t) + g z) + bias_a + n_a
// turned into its axes; at a lever arm r on the rig a(t) has R (dw/dt x r + w x (w x r)) besides, with
// dw/dt by a central difference over 0.2 ms. Along a simulated path both are means over the period of a
// reading, half before and half after t: what is integrated from them is the path, impacts included. With white noise n of standard deviation density * sqrt(rate), and biases that start at 0 and
// take a step of walk / sqrt(rate) from sample to sample (the discrete form of a Wiener process;
// e.g. Crassidis 2006, "Sigma-point Kalman filtering for integrated GPS and inertial navigation",
// appendix). The streams of noise depend on the seed alone.
class Imu {
 public:
  // gravity: unit: m/s2. rig_from_imu: where it sits; nothing: where the rig is. `path` must outlive
  // the unit.
  Imu(const MotionPath& path, const ImuModel& model, double gravity, std::uint64_t seed,
      std::int64_t epoch_ns, const std::optional<Pose>& rig_from_imu = {});

  // Of the sample that comes next.
  std::int64_t next_stamp() const;
  ImuSample take();

  // The samples not yet taken, up to and with this time. Sample k is at k / rate seconds and has
  // the stamp epoch_ns + k * 1e9 / rate, rounded, as frames have.
  std::vector<ImuSample> take_until(std::int64_t stamp_ns);

 private:
  // Without noise, in the unit's axes.
  struct Reading {
    Vec3 turn, felt;  // unit: rad/s, m/s2
  };
  ImuSample sample(std::int64_t index, std::int64_t stamp_ns);
  Reading read_at(double t) const;
  Reading read_mean(double t) const;
  Vec3 lever_acceleration(double t, const CameraMotion& motion) const;

  const MotionPath& path_;
  ImuModel model_;
  double gravity_;
  std::optional<Pose> rig_from_imu_;
  std::int64_t epoch_ns_, next_ = 0;
  RandomStream noise_, walk_;
  Vec3 angular_bias_, acceleration_bias_;
};

}  // namespace rubble
