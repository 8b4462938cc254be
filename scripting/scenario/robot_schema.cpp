#include <algorithm>

#include "scripting/scenario/robot_scenario.h"
#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

std::string key_of(std::size_t robot, const std::string& member) {
  return "robots[" + std::to_string(robot + 1) + "]." + member;
}

// They light what the cameras see, as other lights do.
void check_lamps(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const std::size_t lamps = count_lamps(scenario.robots);
  if (lamps == 0 || lamps + scenario.lights.size() <= kMostLights) return;
  mistakes.push_back({"", 0, "robots", "too many lamps",
                      "at most " + std::to_string(kMostLights - 1) + " lamps of robots and `lights` together",
                      std::to_string(lamps) + " and " + std::to_string(scenario.lights.size() - 1), ""});
}

// What a function is to be told of must be there.
void check_senses(const Scenario& scenario, std::size_t i, std::vector<Diagnostic>& mistakes) {
  const RobotItem& robot = scenario.robots[i];
  if (robot.senses.empty()) return;
  if (robot.control == 0)
    mistakes.push_back({"", 0, key_of(i, "senses"), "there is no controller", "a function as `control`", "no function", ""});
  std::vector<std::string> names;
  for (const MountedCamera& camera : scenario.cameras) {
    names.push_back(camera.name);
    names.push_back(colour_sense(camera.name));
  }
  for (const ImuScenario& imu : scenario.imus) names.push_back(imu.name);
  for (const SensorItem& sensor : scenario.sensors) names.push_back(sensor.name);
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "one of " : ", ") + name;
  for (std::size_t k = 0; k < robot.senses.size(); ++k) {
    if (std::find(names.begin(), names.end(), robot.senses[k]) != names.end()) continue;
    mistakes.push_back({"", 0, key_of(i, "senses[" + std::to_string(k + 1) + "]"),
                        "no sensor has this name", all, "\"" + robot.senses[k] + "\"", ""});
  }
}

// at: the key of the ride, such as "cameras.front.ride"
void check_carrier(const Carrier& ride, const std::string& at, const std::vector<std::string>& names,
                   std::vector<Diagnostic>& mistakes) {
  if (!ride.on() && !ride.link.empty())
    mistakes.push_back({"", 0, at + ".link", "a link without a robot", at + ".robot as well", "\"" + ride.link + "\"", ""});
  if (!ride.on() || std::find(names.begin(), names.end(), ride.robot) != names.end()) return;
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "one of " : ", ") + name;
  mistakes.push_back({"", 0, at + ".robot", "no robot has this name",
                      all.empty() ? "a robot in `robots`" : all, "\"" + ride.robot + "\"", ""});
}

void check_ride(const Scenario& scenario, const std::vector<std::string>& names,
                std::vector<Diagnostic>& mistakes) {
  const TrajectorySpec& path = scenario.trajectory;
  check_carrier(path.ride, "trajectory.ride", names, mistakes);
  if (!path.ride.on()) return;
  const auto add = [&](const char* key, const char* message, const char* expected,
                       const std::string& found) {
    mistakes.push_back({"", 0, key, message, expected, found, ""});
  };
  if (path.waypoints.size() > 1)
    add("trajectory.waypoints", "contradicts ride", "one of both", "both");
  if (path.limits.any() || path.smoothing || path.duration || path.rest_at_ends ||
      path.plan != Plan::ghost)
    add("trajectory.ride", "the path of a robot cannot be changed", "rate_hz only",
        "limits, smoothing, a duration or a plan");
}

std::string carrier_text(const Carrier& carrier) {
  if (!carrier.on()) return "the flying rig";
  return (carrier.link.empty() ? "the first link" : "the link \"" + carrier.link + "\"") + " of \"" + carrier.robot + "\"";
}

// Poses of all sensors in one body: the rig and what it rides on are one, links that joints hold are not.
void check_euroc_units(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const auto carrier_of = [&](const Carrier& ride) { return ride.on() ? ride : Carrier(scenario.trajectory.ride); };
  const Carrier body = carrier_of(scenario.cameras.front().ride);
  for (const ImuScenario& imu : scenario.imus) {
    const Carrier felt = carrier_of(imu.ride);
    if (felt == body) continue;
    mistakes.push_back({"", 0, imu.key() + ".ride", "outputs.euroc has one moving body, that of the cameras",
                        "a unit on " + carrier_text(body) + ", or another format", "one on " + carrier_text(felt), ""});
  }
}

// What a link carries is on no rig: formats that know one moving body alone cannot hold both.
void check_sensor_rides(const Scenario& scenario, const std::vector<std::string>& names,
                        std::vector<Diagnostic>& mistakes) {
  bool mixed = false;
  for (const MountedCamera& camera : scenario.cameras) {
    check_carrier(camera.ride, camera.key() + ".ride", names, mistakes);
    mixed = mixed || !(camera.ride == scenario.cameras.front().ride);
  }
  for (const ImuScenario& imu : scenario.imus) check_carrier(imu.ride, imu.key() + ".ride", names, mistakes);
  for (const SensorItem& sensor : scenario.sensors) check_carrier(sensor.ride, sensor.key() + ".ride", names, mistakes);
  const auto on_rig = [](const auto& sensor) { return !sensor.ride.on(); };
  const bool unseen = std::none_of(scenario.cameras.begin(), scenario.cameras.end(), on_rig);
  if (unseen && (scenario.has_unit_on_rig() ||
                 std::any_of(scenario.sensors.begin(), scenario.sensors.end(), on_rig)))
    mistakes.push_back({"", 0, "cameras", "no camera is on the rig, but another sensor is",
                        "a camera on the rig, or a `ride` for every other sensor on it", "", ""});
  if (mixed && scenario.outputs.euroc)
    mistakes.push_back({"", 0, "outputs.euroc", "the format has one moving body",
                        "cameras on one carrier, or another format", "cameras on several", ""});
  else if (scenario.outputs.euroc)
    check_euroc_units(scenario, mistakes);
}

}  // namespace

void add_ride_keys(Schema& k, const std::string& at, Carrier& ride) {
  k.group(at + "ride", "Link of a robot that carries the sensor, instead of the rig.");
  k.value(at + "ride.robot", ride.robot, "Name of the robot.");
  k.value(at + "ride.link", ride.link, "Link of the robot; not given: the first link.");
}

void add_robot_keys(Schema& k, Scenario& s) {
  add_robot_item_keys(k, s.robots);
  k.group("robot_run", "Duration and rate of the drive.");
  k.value("robot_run.duration", s.robot_run.duration, "Duration of the drive.")
      .above(0, 86400)
      .unit("s");
  k.value("robot_run.control_hz", s.robot_run.control_hz, "Rate of the commands.")
      .between(1, 240)
      .unit("Hz");
  k.choice("robot_run.debris", s.robot_run.debris, {"free", "fixed"},
           "`free`: pieces move when robots push them; `fixed`: pieces do not move.");
  k.value("robot_run.live_light", s.robot_run.live_light,
          "Computes the light of all loose pieces for each image, as `rubble drive` does; false: baked for pieces that never "
          "move.");
}

void check_robots(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const std::vector<std::string> names = robot_names(scenario.robots);
  const bool watched = !scenario.trajectory.ride.on() && std::any_of(scenario.cameras.begin(), scenario.cameras.end(),
                                                                     [](const MountedCamera& c) { return !c.ride.on(); });
  if (scenario.record_settling.on && !watched)
    mistakes.push_back({"", 0, "record_settling", "robots start when the pile rests, and every camera is on a robot",
                        "a camera without `ride`, and a `trajectory` without `ride`", "", ""});
  check_ride(scenario, names, mistakes);
  check_sensor_rides(scenario, names, mistakes);
  check_lamps(scenario, mistakes);
  check_robot_items(scenario.robots, mistakes);
  for (std::size_t i = 0; i < names.size(); ++i) check_senses(scenario, i, mistakes);
}

}  // namespace rubble
