#include "kernel/robot/drive_commands.h"

#include <algorithm>
#include <limits>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kMostSteering = 1.5;  // of a wheel, whatever its joint allows; unit: rad
constexpr double kMostCurvature = 1e3;  // unit: 1/m

// The nearest to angular / linear that all steered wheels reach; on the spot the narrowest; unit: 1/m.
double find_curvature(const RobotModel& model, double linear, double angular) {
  double low = -kMostCurvature, high = kMostCurvature;
  for (const SteeredWheel& wheel : model.sides.steered) {
    const RobotJoint& joint = model.joints[std::size_t(wheel.joint)];
    const auto reach = std::minmax({wheel.sign * joint.lower, wheel.sign * joint.upper});
    const double a = curvature_of(wheel, model.sides.axle, std::max(reach.first, -kMostSteering));
    const double b = curvature_of(wheel, model.sides.axle, std::min(reach.second, kMostSteering));
    low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
  }
  if (linear == 0) return angular > 0 ? high : angular < 0 ? low : 0;
  return std::clamp(angular / linear, low, high);
}

// Every wheel rolls along its own circle about one centre, which is on the line of the axle.
RobotCommand drive_car(const RobotModel& model, double linear, double angular) {
  const SideDrive& sides = model.sides;
  const double curvature = find_curvature(model, linear, angular), apart = 0.5 * sides.distance * curvature;
  RobotCommand command;
  for (const RobotJoint& joint : model.joints) command.joints.push_back({MotorMode::position, joint.start});
  for (int i : sides.left) command.joints[std::size_t(i)] = {MotorMode::velocity, linear * (1 - apart) / sides.radius};
  for (int i : sides.right) command.joints[std::size_t(i)] = {MotorMode::velocity, linear * (1 + apart) / sides.radius};
  for (const SteeredWheel& wheel : sides.steered) {
    const double along = 1 - curvature * wheel.y, across = curvature * (wheel.x - sides.axle);
    const double angle = portable::atan2(across, along);
    command.joints[std::size_t(wheel.joint)] = {MotorMode::position, wheel.sign * angle};
    if (wheel.driven >= 0)
      command.joints[std::size_t(wheel.driven)].target = linear * along / (sides.radius * portable::cos(angle));
  }
  return command;
}

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

// The wheel stands at atan(curvature ahead / (1 - curvature y)). Beyond that there is no such curve.
double curvature_of(const SteeredWheel& wheel, double axle, double angle) {
  const auto [s, c] = portable::sincos(angle);
  const double ahead = wheel.x - axle, down = ahead * c + wheel.y * s;
  if (down * ahead > 0) return s / down;
  return (s * ahead > 0 ? 1 : -1) * std::numeric_limits<double>::infinity();
}

RobotCommand drive_sides(const RobotModel& model, double linear, double angular, const std::vector<double>& flippers) {
  if (!model.sides.steered.empty()) return drive_car(model, linear, angular);
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
