#include "app/robots/ride_recorder.h"

#include <algorithm>
#include <memory>

#include "kernel/base/error.h"
#include "scripting/trajectory/simulated_path.h"

namespace rubble {

RideRecorder::RideRecorder(const Scenario& scenario, const std::vector<MissionRobot>& robots)
    : names_(robot_names(scenario.robots)), robots_(robots) {
  const Ride& rig = scenario.trajectory.ride;
  if (rig.on()) {
    ridden_.push_back(find(rig, "trajectory.ride"));
    ridden_.back().link_from_rider = ridden_.back().link_from_rider * rig.link_from_rig();
    rig_ = true;
  }
  for (const MountedCamera& camera : scenario.cameras) add(camera.ride, "cameras." + camera.name + ".ride");
  for (const LidarScenario& lidar : scenario.lidars) add(lidar.ride, "lidars." + lidar.name + ".ride");
  add(scenario.imu.ride, "imu.ride");
  for (const ImuScenario& imu : scenario.imus) add(imu.ride, "imus." + imu.name + ".ride");
  for (const SensorItem& sensor : scenario.sensors) add(sensor.ride, sensor.key() + ".ride");
}

void RideRecorder::add(const Carrier& carrier, const std::string& key) {
  const auto same = [&](const Ridden& ridden) { return ridden.carrier == carrier; };
  if (!carrier.on() || std::any_of(ridden_.begin() + rig_, ridden_.end(), same)) return;
  ridden_.push_back(find(carrier, key));
}

RideRecorder::Ridden RideRecorder::find(const Carrier& carrier, const std::string& key) const {
  Ridden ridden;
  ridden.carrier = carrier;
  ridden.robot = std::size_t(std::find(names_.begin(), names_.end(), carrier.robot) - names_.begin());
  static_cast<RiddenLink&>(ridden) = find_link(robots_[ridden.robot], carrier.link, key);
  return ridden;
}

void RideRecorder::note(const World& world) {
  for (Ridden& ridden : ridden_) {
    const RobotState state = world.robot_state(int(ridden.robot));
    ridden.poses.push_back(state.links[ridden.link].world_from_link * ridden.link_from_rider);
  }
}

std::optional<RigMount> RideRecorder::finish(double step, const std::vector<RobotRecord>& records,
                                             RobotReadings& readings) {
  std::optional<RigMount> mount;
  for (std::size_t i = 0; i < ridden_.size(); ++i) {
    Ridden& ridden = ridden_[i];
    const auto path = std::make_shared<SimulatedPath>(std::move(ridden.poses), step);
    if (rig_ && i == 0) {
      readings.ride = path;
      mount = RigMount{records[ridden.robot].frame_of(int(ridden.link)), ridden.link_from_rider};
    } else {
      readings.links.push_back({ridden.carrier, path});
    }
  }
  return mount;
}

}  // namespace rubble
