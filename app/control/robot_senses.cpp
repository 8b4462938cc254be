#include "app/control/robot_senses.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "app/control/sense_tables.h"

namespace rubble {

RobotSenses::RobotSenses(const ResolvedMission& mission, const PileState& pile, const std::vector<MissionRobot>& robots,
                         int threads)
    : mission_(mission), pile_(pile), threads_(threads), untold_(robots.size()) {
  const Scenario& scenario = mission.scenario;
  const std::vector<std::string> names = robot_names(scenario.robots);
  for (const MissionRobot& robot : robots) seen_.models.push_back(robot.model);
  std::optional<LinkMount> rig;
  const Ride& ride = scenario.trajectory.ride;
  if (ride.on()) {
    rig = find_link_mount(ride, {}, "trajectory", names, robots);
    rig->link_from_carrier = rig->link_from_carrier * ride.link_from_rig();
  }
  const auto sensed = [&](const std::string& name) {
    for (std::size_t i = 0; i < robots.size(); ++i)
      if (senses(i, name)) return true;
    return false;
  };
  for (std::size_t i = 0; i < scenario.lidars.size(); ++i) {
    const LidarScenario& lidar = scenario.lidars[i];
    if (sensed(lidar.name)) lidars_.push_back({i, find_link_mount(lidar.ride, rig, "lidars." + lidar.name, names, robots)});
  }
  for (const MountedCamera& camera : all_cameras(scenario)) {
    const std::string key = scenario.cameras.empty() ? "camera" : "cameras." + camera.name;
    if (sensed(camera.name)) cameras_.push_back({camera_names_.size(), find_link_mount(camera.ride, rig, key, names, robots)});
    camera_names_.push_back(camera.name);
  }
}

bool RobotSenses::senses(std::size_t robot, const std::string& name) const {
  const std::vector<std::string>& asked = mission_.scenario.robots[robot].senses;
  return std::find(asked.begin(), asked.end(), name) != asked.end();
}

void RobotSenses::begin(const RobotRun& run, double step) {
  if (lidars_.empty() && cameras_.empty()) return;
  const World& world = run.world();
  for (std::size_t i = 0; i < seen_.models.size(); ++i) seen_.first_piece.push_back(world.robot_piece(int(i)));
  const Scenario& scenario = mission_.scenario;
  const Scene scene =
      build_live_scene(scenario, mission_.assets, pile_, seen_, [this](int id, std::int64_t stamp_ns) {
        return ranges_ ? ranges_->pose_of(id, stamp_ns) : std::nullopt;
      });
  ranges_ = std::make_unique<LiveRanges>(scenario, lidars_, cameras_, scene, Medium(scene.air, scene.seed), step, threads_);
  ranges_->restart(world);
}

void RobotSenses::note_step(const World& world) {
  if (ranges_) ranges_->note_step(world);
}

void RobotSenses::measure() {
  LiveRanges::Readings readings = ranges_->take();
  const auto hand_out = [&](const std::string& name, const auto& reading, auto list) {
    for (std::size_t i = 0; i < untold_.size(); ++i)
      if (senses(i, name)) (untold_[i].*list).push_back(reading);
  };
  for (LidarScan& scan : readings.scans) {
    const std::string& name = mission_.scenario.lidars[std::size_t(scan.sensor)].name;
    hand_out(name, std::make_shared<const LidarScan>(std::move(scan)), &Untold::scans);
  }
  for (SensedDepth& image : readings.images) {
    const std::string& name = camera_names_[image.camera];
    hand_out(name, std::make_shared<const SensedDepth>(std::move(image)), &Untold::images);
  }
}

void RobotSenses::tell(std::size_t robot, Value& told) {
  if (!ranges_) return;
  measure();
  const Scenario& scenario = mission_.scenario;
  Value lidars = Value::make_table(), cameras = Value::make_table();
  // Of several since the last call, the newest.
  for (const auto& scan : untold_[robot].scans) {
    const LidarScenario& lidar = scenario.lidars[std::size_t(scan->sensor)];
    lidars.set(lidar.name, describe_scan(*scan, lidar.spec(), scenario.start_ns));
  }
  for (const auto& image : untold_[robot].images)
    cameras.set(camera_names_[image->camera], describe_depth(*image, scenario.start_ns));
  told.set("lidars", std::move(lidars));
  told.set("cameras", std::move(cameras));
  untold_[robot] = {};
}

}  // namespace rubble
