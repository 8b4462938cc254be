#include "app/sensors/robot_readings.h"

#include <algorithm>
#include <cmath>

#include "kernel/world/world_robots.h"

namespace rubble {

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
  // Step i ends at (i + 1) * step_; what rounding leaves of a time must not move it to another step.
  constexpr double kRounding = 1e-6;  // of a step
  const auto count_until = [this](double t) {
    return std::size_t(std::clamp(std::floor(t / step_ + kRounding), 0.0, double(forces_.size())));
  };
  double largest = 0;
  for (std::size_t i = count_until(from); i < count_until(to); ++i) {
    const std::vector<double>& force = forces_[i][robot];
    if (force.empty()) continue;
    double sum = 0;
    for (const std::size_t link : links) sum += force[link];
    largest = std::max(largest, sum);
  }
  return largest;
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
