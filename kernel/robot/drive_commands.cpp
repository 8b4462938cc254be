#include "kernel/robot/drive_commands.h"

namespace rubble {
namespace {

RobotCommand drive_tracks(const RobotModel& model, double left, double right, const std::vector<double>& flippers) {
  RobotCommand command;
  for (const RobotLink& link : model.links) command.belts.push_back(link.belt_side == 0 ? 0 : link.belt_side > 0 ? left : right);
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

RobotCommand drive_wheels(const RobotModel& model, double left, double right) {
  RobotCommand command;
  for (const RobotJoint& joint : model.joints) command.joints.push_back({MotorMode::position, joint.start});
  const SideDrive& sides = model.sides;
  for (int i : sides.left) command.joints[std::size_t(i)] = {MotorMode::velocity, left / sides.radius};
  for (int i : sides.right) command.joints[std::size_t(i)] = {MotorMode::velocity, right / sides.radius};
  return command;
}

}  // namespace

RobotCommand drive_sides(const RobotModel& model, double linear, double angular, const std::vector<double>& flippers) {
  const double apart = 0.5 * model.sides.distance * angular;
  return model.sides.belts ? drive_tracks(model, linear - apart, linear + apart, flippers)
                           : drive_wheels(model, linear - apart, linear + apart);
}

RobotCommand grow_tube(const RobotModel& model, double speed, double curve_left, double curve_up) {
  RobotCommand command;
  command.joints.resize(model.joints.size());
  command.joints.back() = {MotorMode::velocity, speed};
  command.curve_left = curve_left;
  command.curve_up = curve_up;
  return command;
}

}  // namespace rubble
