#include "app/robots/felt_links.h"

#include <algorithm>

namespace rubble {

std::vector<FeltLinks> find_felt_links(const Scenario& scenario, const std::vector<MissionRobot>& robots) {
  const std::vector<std::string> names = robot_names(scenario.robots);
  std::vector<FeltLinks> felt;
  for (const SensorItem& sensor : scenario.sensors) {
    FeltLinks& of_sensor = felt.emplace_back();
    if (!sensor.ride.on()) continue;
    of_sensor.robot = std::size_t(std::find(names.begin(), names.end(), sensor.ride.robot) - names.begin());
    const MissionRobot& robot = robots[of_sensor.robot];
    const std::vector<std::string> links = sensor.figures->links();
    if (links.empty()) of_sensor.links = {find_link(robot, sensor.ride.link, sensor.key() + ".ride").link};
    for (std::size_t i = 0; i < links.size(); ++i) {
      try {
        of_sensor.links.push_back(find_link(robot, links[i], "").link);
      } catch (InputError& error) {
        std::vector<Diagnostic> mistakes = error.diagnostics();
        mistakes.front().key = sensor.key() + ".links[" + std::to_string(i + 1) + "]";
        throw InputError(std::move(mistakes));
      }
    }
  }
  return felt;
}

}  // namespace rubble
