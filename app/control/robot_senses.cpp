#include "app/control/robot_senses.h"

#include <algorithm>
#include <map>
#include <utility>

#include "app/control/sense_tables.h"

namespace rubble {

namespace {

bool senses(const RobotItem& robot, const std::string& name) {
  return std::find(robot.senses.begin(), robot.senses.end(), name) != robot.senses.end();
}

}  // namespace

bool is_sensed(const Scenario& scenario, const std::string& name) {
  return std::any_of(scenario.robots.begin(), scenario.robots.end(),
                     [&](const RobotItem& robot) { return senses(robot, name); });
}

RobotSenses::RobotSenses(const Scenario& scenario, std::int64_t start_ns)
    : scenario_(scenario), start_ns_(start_ns), untold_(scenario.robots.size()) {
  for (const MountedCamera& camera : scenario.cameras) camera_names_.push_back(camera.name);
  for (const ImuScenario& imu : scenario.imus) imu_names_.push_back(imu.name);
}

RobotSenses::Sensed RobotSenses::sensed() const {
  Sensed all;
  for (std::size_t i = 0; i < scenario_.sensors.size(); ++i)
    if (is_sensed(scenario_, scenario_.sensors[i].name)) all.readings.push_back(i);
  for (std::size_t i = 0; i < camera_names_.size(); ++i) {
    if (is_sensed(scenario_, camera_names_[i])) all.depths.push_back(i);
    if (is_sensed(scenario_, colour_sense(camera_names_[i]))) all.colours.push_back(i);
  }
  for (std::size_t i = 0; i < imu_names_.size(); ++i)
    if (is_sensed(scenario_, imu_names_[i])) all.imus.push_back(i);
  return all;
}

std::string RobotSenses::sense_of(const Sample& sample) const {
  if (const auto* reading = std::get_if<ImuSample>(&sample)) return imu_names_[std::size_t(reading->sensor)];
  if (const auto* values = std::get_if<Reading>(&sample)) return scenario_.sensors[std::size_t(values->sensor)].name;
  const auto* frame = std::get_if<Frame>(&sample);
  if (!frame) return "";
  const std::string& camera = camera_names_[std::size_t(frame->sensor)];
  return frame->rgb.empty() ? camera : colour_sense(camera);
}

void RobotSenses::hear(const Sample& sample) {
  const std::string sense = sense_of(sample);
  const auto kept = std::make_shared<const Sample>(sample);
  for (std::size_t i = 0; i < untold_.size(); ++i)
    if (senses(scenario_.robots[i], sense)) untold_[i].push_back(kept);
}

void RobotSenses::tell(std::size_t robot, Value& told) {
  std::map<std::string, Value> scanners;  // by kind: a table of its sensors
  for (const SensorKind* kind : sensor_kinds())
    if (kind->most_points() > 0) scanners.emplace(kind->key(), Value::make_table());
  Value cameras = Value::make_table(), images = Value::make_table();
  std::map<std::string, Value> imus, sensors;
  const auto add = [](std::map<std::string, Value>& lists, const std::string& name, Value reading) {
    lists.emplace(name, Value::make_table()).first->second.items.push_back(std::move(reading));
  };
  // Of several scans and pictures since the last call, the newest; of readings, all.
  for (const auto& sample : std::exchange(untold_[robot], {})) {
    if (const auto* reading = std::get_if<ImuSample>(&*sample)) {
      add(imus, imu_names_[std::size_t(reading->sensor)], describe_reading(*reading, start_ns_));
    } else if (const auto* values = std::get_if<Reading>(&*sample)) {
      const SensorItem& sensor = scenario_.sensors[std::size_t(values->sensor)];
      Value described = describe_values(*values, sensor, start_ns_);
      if (values->scan)
        scanners.at(sensor.figures->key()).set(sensor.name, std::move(described));
      else
        add(sensors, sensor.name, std::move(described));
    } else {
      const Frame& frame = std::get<Frame>(*sample);
      const std::string& camera = camera_names_[std::size_t(frame.sensor)];
      if (frame.rgb.empty())
        cameras.set(camera, describe_depth(frame, start_ns_));
      else
        images.set(camera, describe_colours(frame, start_ns_));
    }
  }
  for (auto& [kind, table] : scanners) told.set(kind, std::move(table));
  told.set("cameras", std::move(cameras));
  told.set("images", std::move(images));
  for (const auto& [member, lists] : {std::make_pair("imus", &imus), std::make_pair("sensors", &sensors)}) {
    Value table = Value::make_table();
    for (auto& [name, list] : *lists) table.set(name, std::move(list));
    told.set(member, std::move(table));
  }
}

}  // namespace rubble
