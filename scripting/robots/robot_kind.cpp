#include "scripting/robots/robot_kind.h"

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "kernel/robot/drive_commands.h"

namespace rubble {
namespace {

// What no registration knows more of than its model says.
class RobotOfFile : public RobotKind {
 public:
  std::string name() const override { return "robot"; }
  RobotModel make(const RobotItem&) const override { throw std::logic_error("the model is in a file"); }
  bool has_sides(const RobotItem& robot) const override { return !robot.left_wheels.empty() || !robot.left_tracks.empty(); }
};

}  // namespace

double RobotKind::within(double value, double most) { return std::clamp(value, -most, most); }

RobotCommand RobotKind::command(const RobotModel& model, const RobotLeg& leg, double) const {
  std::vector<double> flippers = leg.flippers;
  for (const double degrees : leg.flippers_deg) flippers.push_back(degrees * (portable::kPi / 180));
  return drive_sides(model, leg.linear, leg.angular, flippers);
}

RobotCommand RobotKind::answer(const RobotModel& model, const RobotLeg& leg) const {
  return model.sides.any() ? command(model, leg, 0) : RobotCommand{};
}

void RobotKind::steer(const TeleopCommand& asked, const RobotItem&, const RobotLeg&, double, RobotLeg& leg) const {
  leg.linear = within(asked.forward * asked.speed + asked.linear.x, 5);
  leg.angular = within(asked.yaw * kTurn + asked.angular.z, 10);
}

const RobotKind& kind_of(const RobotItem& robot) {
  static const RobotOfFile of_file;
  return robot.urdf.empty() ? *robot_kinds().at(std::size_t(robot.model)) : of_file;
}

RobotItem make_robot_item(const std::string& kind, const std::string& key) {
  RobotItem robot;
  std::string all;
  for (const RobotKind* known : robot_kinds()) {
    if (known->name() == kind) return robot;
    ++robot.model;
    all += (all.empty() ? "one of " : ", ") + known->name();
  }
  throw InputError({"", 0, key, "unknown robot", all, "\"" + kind + "\"", ""});
}

}  // namespace rubble
