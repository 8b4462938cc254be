// Bundled ways to drive: gaits of snakes, twists of tracks and wheels. Functions of time alone, with the
// same bits on every machine. SI.
#pragma once

#include "kernel/model/robot.h"

namespace rubble {

// Joint angles of a snake whose hinges turn sideways (odd joints, counted from 1) and up and down (even
// ones) in turn: two waves along the body, each amplitude sin(wave_number i - rate t + phase), i counted
// from 1.
struct SnakeGait {
  double lateral_amplitude = 0, lateral_wave_number = 0, lateral_phase = 0;     // unit: rad
  double vertical_amplitude = 0, vertical_wave_number = 0, vertical_phase = 0;  // unit: rad
  double rate = 0;      // unit: rad/s; negative: backwards
  double steering = 0;  // added to the sideways angles; unit: rad
  double ramp = 1;      // amplitudes grow to their full size within this time; unit: s; > 0
};

SnakeGait lateral_undulation();
SnakeGait sidewinding();
SnakeGait rolling();
// A wave of curvature that runs along the whole length (Hirose), with the vertical joints straight.
SnakeGait serpenoid(double steering);
// The whole body as a helix that rolls about its own axis: round poles.
SnakeGait helical_rolling();

RobotCommand calc_gait(const RobotModel& model, const SnakeGait& gait, double time);

// REP 103: forwards, and counter-clockwise seen from above.
struct Twist {
  double linear = 0;   // unit: m/s
  double angular = 0;  // unit: rad/s
};
// Speeds of tracks or wheels that would give the twist without slip. flippers: by joint; unit: rad.
RobotCommand drive_crawler(const RobotModel& model, const Twist& twist,
                           const std::vector<double>& flippers);
// By the wheels of model.sides; other motors stay where their joints started.
RobotCommand drive_wheels(const RobotModel& model, const Twist& twist);

// How a tube grows: the speed of its tip, and the curvature of what grows, to the left and upwards.
struct Growth {
  double speed = 0;                    // unit: m/s; negative: it retracts
  double curve_left = 0, curve_up = 0; // unit: 1/m
};
RobotCommand drive_vine(const RobotModel& model, const Growth& growth);

}  // namespace rubble
