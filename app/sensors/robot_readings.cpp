#include "app/sensors/robot_readings.h"

#include <algorithm>
#include <cmath>

#include "kernel/world/world_robots.h"

namespace rubble {
namespace {

// Steps that end by that time. Step i ends at (i + 1) * step; what rounding leaves of a time must not move it to another.
std::size_t count_steps(double t, double step, std::size_t known) {
  constexpr double kRounding = 1e-6;  // of a step
  return std::size_t(std::clamp(std::floor(t / step + kRounding), 0.0, double(known)));
}

}  // namespace

void ContactHistory::note(const World& world, int robots) {
  std::vector<std::vector<double>>& step = forces_.emplace_back(std::size_t(robots));
  for (int robot = 0; robot < robots; ++robot) {
    const int first = world.robots().first_piece(robot), links = int(world.robots().model(robot).links.size());
    std::vector<double>& force = step[std::size_t(robot)];
    for (const RobotContact& contact : world.robots().contacts(robot)) {
      if (contact.piece >= first && contact.piece < first + links) continue;  // the robot itself
      if (force.empty()) force.resize(std::size_t(links));
      force[std::size_t(contact.link)] += contact.force;
    }
  }
}

double ContactHistory::largest_force(std::size_t robot, const std::vector<std::size_t>& links, double from, double to) const {
  double largest = 0;
  for (std::size_t i = count_steps(from, step_, forces_.size()); i < count_steps(to, step_, forces_.size()); ++i) {
    const std::vector<double>& force = forces_[i][robot];
    if (force.empty()) continue;
    double sum = 0;
    for (const std::size_t link : links) sum += force[link];
    largest = std::max(largest, sum);
  }
  return largest;
}

namespace {

// Of the belts, in the last step; unit: W
double belt_power(const RobotModel& model, const RobotState& state) {
  double power = 0;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const RobotState::Link& link = state.links[i];
    const Quat to_link = link.world_from_link.rotation.conjugate();
    // As the surface that lies on the ground moves.
    const Vec3 way = cross(model.links[i].belt_axis, to_link.rotate({0, 0, -1}));
    power += std::max(-dot(to_link.rotate(link.contact_force), way) * link.belt_speed, 0.0);
  }
  return power;
}

}  // namespace

void MotorHistory::note(const World& world, int robots) {
  joints_.resize(std::size_t(robots)), given_.resize(std::size_t(robots));
  for (std::size_t robot = 0; robot < std::size_t(robots); ++robot) {
    const RobotState state = world.robots().state(int(robot));
    double given = belt_power(world.robots().model(int(robot)), state) * step_;
    std::vector<double>& joints = joints_[robot];
    joints.resize(state.joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
      given += std::max(state.joints[i].work - joints[i], 0.0);
      joints[i] = state.joints[i].work;
    }
    std::vector<double>& sums = given_[robot];
    sums.push_back((sums.empty() ? 0 : sums.back()) + (state.lost ? 0 : given));
  }
}

double MotorHistory::work(std::size_t robot, double from, double to) const {
  if (robot >= given_.size()) return 0;
  const std::vector<double>& sums = given_[robot];
  const auto until = [&](double t) {
    const std::size_t steps = count_steps(t, step_, sums.size());
    return steps == 0 ? 0 : sums[steps - 1];
  };
  return until(to) - until(from);
}

namespace {

constexpr std::int64_t kRounding = 1000;  // of a stamp at the end of a way; unit: ns

}  // namespace

const std::shared_ptr<const MotionPath>& RobotReadings::path_of(
    const Carrier& carrier, const std::shared_ptr<const MotionPath>& rig) const {
  if (!carrier.on()) return rig;
  for (const LinkWay& link : links)
    if (link.carrier == carrier) return link.path;
  static const std::shared_ptr<const MotionPath> nowhere;
  return nowhere;
}

std::int64_t RobotReadings::end_of(const Carrier& carrier, const std::shared_ptr<const MotionPath>& rig, std::int64_t start_ns,
                                   std::int64_t last_ns) const {
  return std::min(last_ns, start_ns + std::int64_t(path_of(carrier, rig)->duration() * 1e9 + 0.5) + kRounding);
}

}  // namespace rubble
