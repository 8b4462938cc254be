// Odometry of robots with two driven sides: what belts or wheel encoders say, beside the truth.
#pragma once

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

// Dead reckoning along arcs from the way of each side, as tracked and wheeled robots have it; the distance
// of the sides is the one between their middles, so that the yaw of what skids is too large.
class WheelOdometry {
 public:
  // model: with sides; it must outlive the odometry.
  explicit WheelOdometry(const RobotModel& model) : model_(&model) {}

  // time: rising; unit: s. Belts must have kept their speed since the call before.
  OdometryReading update(const RobotState& state, double time);

  // Over all readings: the way that the sides' surfaces slipped, by the way that they ran; 0 to 1 and more.
  double mean_slip() const { return ran_ > 0 ? slipped_ / ran_ : 0; }

 private:
  double way_of(const std::vector<int>& side, const RobotState& state, double dt) const;

  const RobotModel* model_;
  bool started_ = false;
  double time_ = 0;
  Vec3 place_;
  double true_yaw_ = 0;
  RobotState last_;
  OdometryReading reading_;
  double slipped_ = 0, ran_ = 0;  // unit: m
};

}  // namespace rubble
