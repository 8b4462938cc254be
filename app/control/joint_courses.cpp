#include "app/control/joint_courses.h"

#include <algorithm>
#include <utility>

#include "app/control/robot_control.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

constexpr double kMost = 1000;  // of what a mission can ask of a joint; unit: rad, slider m

[[noreturn]] void refuse(const std::string& key, const std::string& message, const std::string& expected,
                         const std::string& found, const std::string& hint = "") {
  throw InputError({"", 0, key, message, expected, found, hint});
}

std::string point_key(std::size_t i, const char* member) {
  return "points[" + std::to_string(i) + "]." + member;
}

void check_points(const JointTrajectoryCommand& trajectory) {
  const std::size_t joints = trajectory.joints.size();
  const std::string names = std::to_string(joints) + ", as joint_names has";
  double last = -1;
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const JointTrajectoryCommand::Point& point = trajectory.points[i];
    if (point.positions.size() != joints)
      refuse(point_key(i, "positions"), "wrong number of positions", names, std::to_string(point.positions.size()));
    if (!point.velocities.empty() && point.velocities.size() != joints)
      refuse(point_key(i, "velocities"), "wrong number of velocities", names + ", or none",
             std::to_string(point.velocities.size()));
    if (point.time < 0 || point.time <= last)
      refuse(point_key(i, "time_from_start"), "not in order",
             i == 0 ? "0 s or more" : "more than " + exact_text(last) + " s", exact_text(point.time) + " s");
    last = point.time;
  }
}

void check_limits(const RobotJoint& joint, const JointTrajectoryCommand& trajectory, std::size_t column) {
  const char* const unit = joint.kind == JointKind::slider ? " m" : " rad";
  const double lower = std::max(joint.lower, -kMost), upper = std::min(joint.upper, kMost);
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const double position = trajectory.points[i].positions[column];
    if (position >= lower && position <= upper) continue;
    refuse(point_key(i, "positions"), "beyond the limits of " + joint.name,
           exact_text(lower) + " to " + exact_text(upper) + unit, exact_text(position) + unit);
  }
}

}  // namespace

void JointCourses::begin(const JointTrajectoryCommand& trajectory, const RobotModel& model, const RobotState& state,
                         double time) {
  if (model.tube)
    refuse("joint_names", "a robot that grows has no joints that can be asked for positions", "/cmd_vel",
           std::to_string(trajectory.joints.size()) + " joints", "/cmd_vel makes it grow and bend");
  if (trajectory.points.empty()) return end();
  if (trajectory.joints.empty()) refuse("joint_names", "no joint is named", "names of joints", "an empty list");
  check_points(trajectory);
  std::map<std::size_t, std::pair<std::string, Course>> courses;
  for (std::size_t column = 0; column < trajectory.joints.size(); ++column) {
    const std::string& name = trajectory.joints[column];
    const std::size_t joint = find_motor(model, name, "joint_names");
    check_limits(model.joints[joint], trajectory, column);
    const auto known = courses_.find(joint);
    Knot from{time, state.joints[joint].position, 0, false};
    if (known != courses_.end()) from = at(known->second.second, time);
    Course course{from};
    for (const JointTrajectoryCommand::Point& point : trajectory.points) {
      Knot knot{time + point.time, point.positions[column], 0, !point.velocities.empty()};
      if (knot.smooth) knot.velocity = point.velocities[column];
      course.front().smooth = course.front().smooth || knot.smooth;  // it begins with the speed it has
      if (knot.time <= course.back().time) course.pop_back();        // at once
      course.push_back(knot);
    }
    if (!courses.emplace(joint, std::make_pair(name, std::move(course))).second)
      refuse("joint_names", "a joint is named twice", "each joint once", "\"" + name + "\"");
  }
  for (auto& [joint, course] : courses) courses_[joint] = std::move(course);
}

JointCourses::Knot JointCourses::at(const Course& course, double time) {
  const auto next = std::upper_bound(course.begin(), course.end(), time,
                                     [](double t, const Knot& knot) { return t < knot.time; });
  if (next == course.end()) return {time, course.back().position, 0, false};
  if (next == course.begin()) return {time, course.front().position, 0, false};
  const Knot &a = *(next - 1), &b = *next;
  const double span = b.time - a.time, s = (time - a.time) / span, way = b.position - a.position;
  if (!a.smooth || !b.smooth) return {time, a.position + s * way, way / span, false};
  const double u = 1 - s;
  const double position = a.position + way * s * s * (3 - 2 * s) + span * s * u * (a.velocity * u - b.velocity * s);
  const double velocity = 6 * s * u * way / span + a.velocity * u * (1 - 3 * s) + b.velocity * s * (3 * s - 2);
  return {time, position, velocity, false};
}

void JointCourses::ask(double time, RobotLeg& leg) const {
  leg.joints.clear(), leg.joint_names.clear();
  for (const auto& [joint, course] : courses_) {
    leg.joint_names.push_back(course.first);
    leg.joints.push_back(std::clamp(at(course.second, time).position, -kMost, kMost));
  }
}

}  // namespace rubble
