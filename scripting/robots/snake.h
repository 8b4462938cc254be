// The snake: a chain of modules that moves by waves. Figures and their sources: docs/reference/robots.md. SI.
#pragma once

#include "kernel/model/robot.h"

namespace rubble {

// A chain of equal modules with hinges about Z and Y in turn, as the CMU unified snake. Link 0 is the head,
// X forwards. Joint i connects link i + 1 behind link i. Origin: the middle of the head.
struct SnakeOptions {
  int modules = 16;          // range: 2 to 64
  double diameter = 0.052;   // unit: m; range: 0.01 to 1
  double length = 0.0585;    // of a module; unit: m; range: 0.01 to 1
  double module_mass = 0.2;  // unit: kg; range: 0.001 to 100
  double effort = 7;         // unit: N m; range: 0.01 to 1000
  double speed = 3;          // unit: rad/s; range: 0.1 to 30
  double friction = 0.5;     // range: 0 to 2
};
RobotModel make_snake(const SnakeOptions& options = {});

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

// A module from x = to - length to x = to, which bends about `front_axis_z ? Z : Y` in front and about the
// other behind. The head has no joint in front, the tail none behind.
struct SnakeModuleSize {
  double radius = 0, length = 0, to = 0;  // unit: m
};
TriangleMesh make_snake_module_looks(const SnakeModuleSize& size, bool front_axis_z, bool head, bool tail);

}  // namespace rubble
