#include "app/robots/link_sensors.h"

#include <algorithm>

#include "app/planning/solid_matter.h"
#include "kernel/robot/parts.h"

namespace rubble {
namespace {

class Finder {
 public:
  Finder(const Scenario& scenario, const std::vector<MissionRobot>& robots)
      : rig_(scenario.trajectory.ride), robots_(robots), names_(robot_names(scenario.robots)) {}

  // What is on the rig hangs on the link that carries that.
  void look(const std::string& key, const Carrier& carrier, const Pose& carrier_from_sensor) {
    if (!carrier.on() && !rig_.on()) return;
    const Carrier& on = carrier.on() ? carrier : rig_;
    const Pose link_from_carrier = carrier.on() ? Pose() : rig_.link_from_rig();
    const auto robot = std::size_t(std::find(names_.begin(), names_.end(), on.robot) - names_.begin());
    const RiddenLink ridden = find_link(robots_[robot], on.link, carrier.on() ? key + ".ride" : "trajectory.ride");
    const RobotLink& link = robots_[robot].model.links[ridden.link];
    const Vec3 place = (ridden.link_from_rider * link_from_carrier * carrier_from_sensor).translation;
    if (calc_winding_number(make_link_mesh(link, ""), place) < 0.5) return;
    warnings_.push_back(key + ": the sensor is inside of `" + link.name +
                        "`, the link that carries it, and sees nothing else; `position` moves it out");
  }
  std::vector<std::string> take() { return std::move(warnings_); }

 private:
  const Ride& rig_;
  const std::vector<MissionRobot>& robots_;
  std::vector<std::string> names_, warnings_;
};

}  // namespace

std::vector<std::string> find_buried_sensors(const Scenario& scenario, const std::vector<MissionRobot>& robots) {
  Finder finder(scenario, robots);
  for (const MountedCamera& camera : scenario.cameras) finder.look(camera.key(), camera.ride, camera.rig_from_camera());
  for (const SensorItem& sensor : scenario.sensors)
    if (sensor.figures->casts_rays()) finder.look(sensor.key(), sensor.ride, sensor.carrier_from_sensor());
  return finder.take();
}

void check_ridden_links(const Scenario& scenario, const std::vector<MissionRobot>& robots) {
  const std::vector<std::string> names = robot_names(scenario.robots);
  const auto check = [&](const Carrier& carrier, const std::string& key) {
    if (!carrier.on()) return;
    find_link(robots[std::size_t(std::find(names.begin(), names.end(), carrier.robot) - names.begin())], carrier.link, key);
  };
  check(scenario.trajectory.ride, "trajectory.ride");
  for (const MountedCamera& camera : scenario.cameras) check(camera.ride, camera.key() + ".ride");
  for (const ImuScenario& imu : scenario.imus) check(imu.ride, imu.key() + ".ride");
  for (const SensorItem& sensor : scenario.sensors) check(sensor.ride, sensor.key() + ".ride");
  find_felt_links(scenario, robots);
}

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
