#include "app/sensors/contact_history.h"
#include "kernel/world/world_robots.h"

#include <algorithm>
#include <cmath>

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

}  // namespace rubble
