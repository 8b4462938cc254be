// Bundled controllers: gaits of snakes, twists of tracks and wheels. They depend on time only and have the same
// bits on every machine. SI.
#pragma once

#include "kernel/model/robot.h"

namespace rubble {

// Joint angles of a snake with lateral hinges (odd joints, counted from 1) and vertical hinges (even joints): two
// waves along the body, each amplitude sin(wave_number i - rate t + phase).
struct SnakeGait {
  double lateral_amplitude = 0, lateral_wave_number = 0, lateral_phase = 0;     // unit: rad
  double vertical_amplitude = 0, vertical_wave_number = 0, vertical_phase = 0;  // unit: rad
  double rate = 0;      // unit: rad/s; negative: backwards
  double steering = 0;  // added to the lateral angles; unit: rad
  double ramp = 1;      // amplitudes grow to their full size within this time; unit: s; > 0
};

SnakeGait lateral_undulation();
SnakeGait sidewinding();
SnakeGait rolling();
// A wave of curvature along the whole length (Hirose), with straight vertical joints.
SnakeGait serpenoid(double steering);
// The body forms a helix that rolls about its own axis, to climb poles.
SnakeGait helical_rolling();

RobotCommand calc_gait(const RobotModel& model, const SnakeGait& gait, double time);

// REP 103: forwards, and counter-clockwise seen from above.
struct Twist {
  double linear = 0;   // unit: m/s
  double angular = 0;  // unit: rad/s
};
// Speeds of tracks or wheels for a twist without slip. flippers: angles by joint; unit: rad.
RobotCommand drive_tracks(const RobotModel& model, const Twist& twist,
                           const std::vector<double>& flippers);
// Drives the wheels of model.sides. Other motors keep the initial positions of their joints.
RobotCommand drive_wheels(const RobotModel& model, const Twist& twist);

// Growth of a tube: speed of its tip, and curvature of the new part, to the left and upwards.
struct Growth {
  double speed = 0;                    // unit: m/s; negative: it retracts
  double curve_left = 0, curve_up = 0; // unit: 1/m
};
RobotCommand drive_vine(const RobotModel& model, const Growth& growth);

}  // namespace rubble
