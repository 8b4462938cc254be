#include "scripting/robots/snake.h"

#include <algorithm>
#include <string>

#include "kernel/base/portable_math.h"
#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr int kSnakeFacets = 12;
// A module is narrower at its ends, so that only neighbours, which pass each other, meet in a bend; unit: 1.
constexpr double kEndRadius = 0.75, kNarrowing = 0.2;
// The servo's gains; unit: N m/rad, N m s/rad. Stiff: 7 N m are reached at 4 degrees.
constexpr double kStiffness = 100, kDamping = 2;
constexpr double kMostBend = 1.5707963267948966;  // unit: rad

}  // namespace

RobotModel make_snake(const SnakeOptions& options) {
  RobotModel model;
  model.name = "snake";
  const double radius = 0.5 * options.diameter, length = options.length;
  model.headlamp.link_from_lamp.translation = {0.55 * length, 0, 0};
  for (int i = 0; i < options.modules; ++i) {
    RobotLink link;
    link.name = i == 0 ? "head" : "module_" + std::to_string(i);
    const double front = i == 0 ? 0.5 * length : 0;
    link.parts = {make_tube(radius, kEndRadius * radius, front - length, front, kNarrowing * length,
                            kSnakeFacets)};
    link.friction = options.friction;
    set_mass(options.module_mass, link);
    link.looks = make_snake_module_looks({radius, length, front}, i % 2 == 1, i == 0, i + 1 == options.modules);
    model.links.push_back(link);
    if (i == 0) continue;
    RobotJoint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.parent = i - 1;
    joint.child = i;
    joint.parent_from_child.translation = {i == 1 ? -0.5 * length : -length, 0, 0};
    joint.axis = i % 2 == 1 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    joint.lower = -kMostBend;
    joint.upper = kMostBend;
    joint.motor = {options.effort, options.speed, kStiffness, kDamping};
    model.joints.push_back(joint);
  }
  return model;
}

SnakeGait lateral_undulation() {
  SnakeGait gait;
  gait.lateral_amplitude = 0.6, gait.lateral_wave_number = 0.7;
  gait.vertical_amplitude = 0.1, gait.vertical_wave_number = 1.4;
  gait.rate = 4;
  return gait;
}

SnakeGait sidewinding() {
  SnakeGait gait;
  gait.lateral_amplitude = 0.9, gait.lateral_wave_number = 0.5;
  gait.vertical_amplitude = 1.1, gait.vertical_wave_number = 0.5;
  gait.vertical_phase = 0.25 * portable::kPi;
  gait.rate = 4;
  return gait;
}

SnakeGait rolling() {
  SnakeGait gait;
  gait.lateral_amplitude = gait.vertical_amplitude = 0.3;
  gait.vertical_phase = 0.5 * portable::kPi;
  gait.rate = 4;
  return gait;
}

SnakeGait serpenoid(double steering) {
  SnakeGait gait;
  gait.lateral_amplitude = 0.6, gait.lateral_wave_number = 0.7;
  gait.rate = 4;
  gait.steering = steering;
  return gait;
}

SnakeGait helical_rolling() {
  SnakeGait gait;
  gait.lateral_amplitude = gait.vertical_amplitude = 0.6;
  gait.lateral_wave_number = gait.vertical_wave_number = 0.3;
  gait.vertical_phase = 0.5 * portable::kPi;
  gait.rate = 4;
  return gait;
}

RobotCommand calc_gait(const RobotModel& model, const SnakeGait& gait, double time) {
  const double grown = std::clamp(time / gait.ramp, 0.0, 1.0);
  RobotCommand command;
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    const double i = double(k) + 1;
    const bool lateral = k % 2 == 0;
    const double wave = lateral ? gait.lateral_wave_number * i + gait.lateral_phase
                                : gait.vertical_wave_number * i + gait.vertical_phase;
    const double amplitude = lateral ? gait.lateral_amplitude : gait.vertical_amplitude;
    const double angle = amplitude * portable::sin(wave - gait.rate * time);
    command.joints.push_back(
        {MotorMode::position, grown * (angle + (lateral ? gait.steering : 0))});
  }
  return command;
}

}  // namespace rubble
