// Commands for what models have in common: tracks or wheels at their sides, a tube that grows. They have the same bits on
// every machine. SI.
#pragma once

#include <vector>

#include "kernel/model/robot.h"

namespace rubble {

// Speeds of the tracks or wheels of model.sides for a twist without slip (REP 103: forwards, unit: m/s; counter-clockwise,
// unit: rad/s). flippers: positions of the motors of a tracked robot, in their order; unit: rad. Other motors keep the
// initial positions of their joints.
// A car follows as narrow a curve as its steering reaches, and does not turn on the spot: then it turns its wheels alone.
RobotCommand drive_sides(const RobotModel& model, double linear, double angular, const std::vector<double>& flippers = {});

// The curvature that a wheel which stands at this angle belongs to; unit: rad, 1/m.
double curvature_of(const SteeredWheel& wheel, double axle, double angle);

// Speed of the tip of model.tube (negative: it retracts; unit: m/s), and curvature of the new part; unit: 1/m.
RobotCommand grow_tube(const RobotModel& model, double speed, double curve_left = 0, double curve_up = 0);

}  // namespace rubble
