#include "python/robot_commands.h"


#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/robot/drive_commands.h"

namespace rubble::python {
namespace {

constexpr double kMostCurvature = 1000;  // far beyond what bends a tube; unit: 1/m

void expect(bool fine, const char* key, const char* message, const std::string& expected) {
  if (!fine) throw InputError({"", 0, key, message, expected, "", ""});
}

void expect_finite(const std::vector<double>& values, const char* key, const char* expected) {
  expect(std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }), key, "not a finite number",
         expected);
}

}  // namespace

RobotCommand make_twist_command(const RobotModel& model, double linear, double angular,
                                const std::vector<double>& flippers) {
  expect(model.sides.any(), "drive", "this robot has neither tracks nor wheels", "crawler or rover");
  expect_finite({linear, angular}, "drive", "m/s and rad/s");
  const auto motors = std::size_t(std::count_if(model.joints.begin(), model.joints.end(),
                                                [](const RobotJoint& joint) { return joint.motor.effort > 0; }));
  const std::size_t wanted = model.sides.belts ? motors : 0;
  expect(flippers.empty() || flippers.size() == wanted, "flippers", "wrong number of angles",
         wanted ? std::to_string(wanted) + " or none" : "none");
  expect_finite(flippers, "flippers", "radians");
  return drive_sides(model, linear, angular, flippers);
}

RobotCommand make_growth_command(const RobotModel& model, double speed, double left, double up) {
  expect(model.tube.has_value(), "grow", "this robot does not grow", "a robot with a tube");
  expect_finite({speed, left, up}, "grow", "a finite speed and finite curvatures");
  expect(std::max(std::abs(left), std::abs(up)) <= kMostCurvature, "grow", "curvature out of range", "-1000 to 1000 1/m");
  return grow_tube(model, speed, left, up);
}

RobotCommand make_joints_command(const RobotModel& model, const std::vector<double>& targets) {
  expect(targets.size() == model.joints.size(), "targets", "wrong number of angles", std::to_string(model.joints.size()));
  expect_finite(targets, "targets", "radians");
  expect(std::all_of(model.joints.begin(), model.joints.end(),
                     [](const RobotJoint& joint) { return joint.motor.effort <= 0 || joint.motor.stiffness > 0; }),
         "set_joints", "this robot has motors that turn at a speed and hold no position", "drive(linear, angular)");
  RobotCommand command;
  for (const double target : targets) command.joints.push_back({MotorMode::position, target});
  return command;
}

nb::dict describe_state(const RobotModel& model, const RobotState& s, double time) {
  nb::dict out;
  Array<double> links = make_array<double>({Size(s.links.size()), 7});
  for (std::size_t i = 0; i < s.links.size(); ++i) put_pose(s.links[i].world_from_link, links.data() + 7 * i);
  std::vector<double> angles, speeds, torques, forces;
  for (const RobotState::Joint& j : s.joints)
    angles.push_back(j.position), speeds.push_back(j.speed), torques.push_back(j.torque);
  for (const RobotState::Link& link : s.links)
    for (int k = 0; k < 3; ++k) forces.push_back(link.contact_force[k]);
  const auto joints = Size(s.joints.size());
  out["time"] = time;
  out["links"] = links;
  out["joint_positions"] = take_vector(std::move(angles), {joints});
  out["joint_speeds"] = take_vector(std::move(speeds), {joints});
  out["joint_torques"] = take_vector(std::move(torques), {joints});
  out["contact_forces"] = take_vector(std::move(forces), {Size(s.links.size()), 3});
  out["linear_velocity"] = from_vector(s.links[0].linear), out["angular_velocity"] = from_vector(s.links[0].angular);
  if (model.tube) out["length"] = s.length, out["tip_force"] = s.tip_force;
  out["lost"] = s.lost;
  return out;
}

std::vector<std::string> link_names_of(const RobotModel& model) {
  std::vector<std::string> names;
  for (const RobotLink& link : model.links) names.push_back(link.name);
  return names;
}

int count_steps(double seconds, double step) {
  expect(seconds > 0 && seconds <= 60, "seconds", "out of range", "more than 0, at most 60");
  return std::max(1, int(seconds / step + 0.5));
}

}  // namespace rubble::python
