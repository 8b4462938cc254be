#include "kernel/robot/gaits.h"

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "kernel/robot/bundled.h"

namespace rubble {

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

RobotCommand drive_tracks(const RobotModel& model, const Twist& twist,
                           const std::vector<double>& flippers) {
  RobotCommand command;
  const double apart = 0.5 * model.sides.distance * twist.angular;
  for (const RobotLink& link : model.links)
    command.belts.push_back(link.belt_side == 0 ? 0 : link.belt_side > 0 ? twist.linear - apart : twist.linear + apart);
  std::size_t flipper = 0;
  for (const RobotJoint& joint : model.joints) {
    MotorCommand motor;
    if (joint.motor.effort > 0) {
      motor = {MotorMode::position, flipper < flippers.size() ? flippers[flipper] : joint.start};
      ++flipper;
    }
    command.joints.push_back(motor);
  }
  return command;
}

RobotCommand drive_wheels(const RobotModel& model, const Twist& twist) {
  RobotCommand command;
  for (const RobotJoint& joint : model.joints)
    command.joints.push_back({MotorMode::position, joint.start});
  const SideDrive& sides = model.sides;
  const double apart = 0.5 * sides.distance * twist.angular;
  for (int i : sides.left)
    command.joints[std::size_t(i)] = {MotorMode::velocity, (twist.linear - apart) / sides.radius};
  for (int i : sides.right)
    command.joints[std::size_t(i)] = {MotorMode::velocity, (twist.linear + apart) / sides.radius};
  return command;
}

RobotCommand drive_vine(const RobotModel& model, const Growth& growth) {
  RobotCommand command;
  command.joints.resize(model.joints.size());
  command.joints.back() = {MotorMode::velocity, growth.speed};
  command.curve_left = growth.curve_left;
  command.curve_up = growth.curve_up;
  return command;
}

}  // namespace rubble
