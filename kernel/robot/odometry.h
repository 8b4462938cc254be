// Odometry of robots with two driven sides: what belts or wheel encoders say, beside the truth.
#pragma once

#include "kernel/base/random.h"
#include "kernel/model/robot.h"

namespace rubble {

// At one time. Speeds are means since the reading before; 0 in the first.
struct OdometryReading {
  double x = 0, y = 0, yaw = 0;        // of the base in the plane in which it started; unit: m, rad
  double linear = 0, angular = 0;      // forwards, counter-clockwise; unit: m/s, rad/s
  double left = 0, right = 0;          // of the belts' or wheels' surfaces; unit: m/s
  double true_left = 0, true_right = 0;    // of the base over the middle of each side, forwards; unit: m/s
  double true_linear = 0, true_angular = 0;  // of the base; unit: m/s, rad/s

  // The share of a surface's way that moved nothing; 0: it rolls, 1: it spins on the spot, negative: it is
  // dragged along. 0 while the surface stands still.
  double slip_left() const;
  double slip_right() const;
};

// The random part of what a side reports: independent of the past, so that its variance grows with the way (Kleeman
// 1995). What slips is no part of it: that is simulated.
struct OdometryNoise {
  // Standard deviation over one metre; it grows with the root of the way. unit: m; range: 0 to 0.1.
  // 0.001 for tracks: it turns odometry of a straight way of 40.5 m by 0.43 m in the mean, where Pentzer and others
  // (J. Field Robotics 31, 2014) found 0.42 m on a tracked vehicle whose turning was calibrated.
  double over_a_metre = 0;
  std::uint64_t seed = 0;
  int robot = 0;  // number of the robot: each has noise of its own
};

// Dead reckoning along arcs from the way of each side, as tracked and wheeled robots have it; the distance
// of the sides is the one between their middles, so that the yaw of what skids is too large.
class WheelOdometry {
 public:
  // model: with sides; it must outlive the odometry.
  explicit WheelOdometry(const RobotModel& model, const OdometryNoise& noise = {});

  // time: rising; unit: s. Belts must have kept their speed since the call before.
  OdometryReading update(const RobotState& state, double time);

  // Over all readings: the way that the sides' surfaces slipped, by the way that they ran; 0 to 1 and more.
  double mean_slip() const { return ran_ > 0 ? slipped_ / ran_ : 0; }

 private:
  double way_of(const std::vector<int>& side, const RobotState& state, double dt) const;
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
