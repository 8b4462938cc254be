// Odometry of robots that belts or wheels at their sides drive: their encoders, those of steering, and the truth.
#pragma once

#include <array>

#include "kernel/base/random.h"
#include "kernel/model/robot.h"

namespace rubble {

// Speeds are means since the previous reading; 0 in the first.
struct OdometryReading {
  double x = 0, y = 0, yaw = 0;        // of the base in the plane of its start; unit: m, rad
  double linear = 0, angular = 0;      // forwards, counter-clockwise; unit: m/s, rad/s
  // What the random error of the encoders adds up to; of slip it knows nothing. Of x, y and yaw; unit: m2, m rad, rad2
  std::array<std::array<double, 3>, 3> covariance{};
  double linear_variance = 0, angular_variance = 0;  // of the speeds; unit: (m/s)2, (rad/s)2
  double left = 0, right = 0;          // of the belts' or wheels' surfaces; unit: m/s
  double true_left = 0, true_right = 0;    // of the base at the middle of each side, forwards; unit: m/s
  double true_linear = 0, true_angular = 0;  // of the base; unit: m/s, rad/s

  // Slip ratio of a side. 0: it rolls, 1: it spins on the spot, negative: it is dragged along. 0 while the surface
  // stands still.
  double slip_left() const;
  double slip_right() const;
};

// A covariance supposes at least this error, which tracks have: nothing real is exact. As OdometryNoise::over_a_metre.
inline constexpr double kLeastOdometryError = 0.001;

// Random error of the encoders of a side. It is independent of the past, so its variance grows with the distance
// (Kleeman 1995). Slip is not part of it: slip is simulated.
struct OdometryNoise {
  // Standard deviation over one metre; it grows with the square root of the distance. unit: m; range: 0 to 0.1.
  // Tracks have 0.001: over 40.5 m straight ahead this gives a mean error of 0.43 m. Pentzer and others (J. Field
  // Robotics 31, 2014) measured 0.42 m with a tracked vehicle whose turns were calibrated.
  double over_a_metre = 0;
  std::uint64_t seed = 0;
  int robot = 0;  // number of the robot: robots have different noise
};

// Dead reckoning along arcs from the distances of both sides, as tracked and wheeled robots do it. The track width
// is the distance between the middles of the sides, so the yaw of skidding robots is too large.
class WheelOdometry {
 public:
  // model: must have sides and outlive the odometry.
  explicit WheelOdometry(const RobotModel& model, const OdometryNoise& noise = {});

  // time: increasing; unit: s. Belts must have kept their speed since the previous call.
  OdometryReading update(const RobotState& state, double time);

  // Slipped distance of the surfaces divided by their total distance, over all readings; 0 to 1 and more.
  double mean_slip() const { return ran_ > 0 ? slipped_ / ran_ : 0; }

 private:
  void grow_covariance(double ran_left, double ran_right, double way, double heading);
  double way_of(const std::vector<int>& side, const RobotState& state, double dt) const;
  double turn_of(double left, double right, const RobotState& state) const;
  double as_measured(double way);

  const RobotModel* model_;
  double noise_;  // OdometryNoise::over_a_metre
  RandomStream random_;
  bool started_ = false;
  double time_ = 0;
  Vec3 place_;
  double true_yaw_ = 0;
  RobotState last_;
  OdometryReading reading_;
  double slipped_ = 0, ran_ = 0;  // unit: m
};

}  // namespace rubble
