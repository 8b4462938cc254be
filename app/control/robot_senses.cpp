#include "app/control/robot_senses.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "app/control/sense_tables.h"

namespace rubble {

RobotSenses::RobotSenses(const ResolvedMission& mission, const PileState& pile, const std::vector<MissionRobot>& robots,
                         RunContext& context)
    : mission_(mission), pile_(pile), context_(context), untold_(robots.size()) {
  const Scenario& scenario = mission.scenario;
  const std::vector<std::string> names = robot_names(scenario.robots);
  for (const MissionRobot& robot : robots) seen_.models.push_back(robot.model);
  std::optional<LinkMount> rig;
  const Ride& ride = scenario.trajectory.ride;
  if (ride.on()) {
    rig = find_link_mount(ride, {}, "trajectory", names, robots);
    rig->link_from_carrier = rig->link_from_carrier * ride.link_from_rig();
  }
  for (std::size_t i = 0; i < scenario.lidars.size(); ++i) {
    const LidarScenario& lidar = scenario.lidars[i];
    if (sensed(lidar.name)) lidars_.push_back({i, find_link_mount(lidar.ride, rig, "lidars." + lidar.name, names, robots)});
  }
  for (const MountedCamera& camera : all_cameras(scenario)) {
    const std::string key = scenario.cameras.empty() ? "camera" : "cameras." + camera.name;
    const std::size_t number = camera_names_.size();
    camera_names_.push_back(camera.name);
    if (sensed(camera.name)) depth_cameras_.push_back({number, find_link_mount(camera.ride, rig, key, names, robots)});
    if (sensed(colour_sense(camera.name)))
      colour_cameras_.push_back({number, find_link_mount(camera.ride, rig, key, names, robots)});
  }
  for (const ImuScenario& imu : all_imus(scenario)) {
    const std::string key = scenario.imus.empty() ? "imu" : "imus." + imu.name;
    if (sensed(imu.name)) imus_.push_back({imu_names_.size(), find_link_mount(imu.ride, rig, key, names, robots)});
    imu_names_.push_back(imu.name);
  }
}

bool RobotSenses::senses(std::size_t robot, const std::string& name) const {
  const std::vector<std::string>& asked = mission_.scenario.robots[robot].senses;
  return std::find(asked.begin(), asked.end(), name) != asked.end();
}

bool RobotSenses::sensed(const std::string& name) const {
  for (std::size_t i = 0; i < untold_.size(); ++i)
    if (senses(i, name)) return true;
  return false;
}

template <typename Measurer>
Scene RobotSenses::build_scene(const World& world, const std::unique_ptr<Measurer>& measurer) const {
  const auto pose_of = [&world, &measurer](int id, std::int64_t stamp_ns) -> std::optional<Pose> {
    if (measurer && measurer->measuring()) return measurer->pose_of(id, stamp_ns);
    const PieceState piece = world.piece(id);
    if (piece.status == PieceStatus::lost) return std::nullopt;
    return piece.world_from_body;
  };
  return build_live_scene(mission_.scenario, mission_.assets, pile_, seen_, pose_of);
}

void RobotSenses::begin(const RobotRun& run, double step) {
  if (lidars_.empty() && depth_cameras_.empty() && colour_cameras_.empty() && imus_.empty()) return;
  const World& world = run.world();
  for (std::size_t i = 0; i < seen_.models.size(); ++i) seen_.first_piece.push_back(world.robot_piece(int(i)));
  const Scenario& scenario = mission_.scenario;
  const Scene scene = build_scene(world, ranges_);
  ranges_ = std::make_unique<LiveRanges>(scenario, lidars_, depth_cameras_, scene, Medium(scene.air, scene.seed), step,
                                         context_.threads());
  ranges_->restart(world);
  readings_ = std::make_unique<LiveImus>(scenario, imus_, step);
  readings_->restart(world);
  if (colour_cameras_.empty()) return;
  colours_ = std::make_unique<LiveColours>(
      scenario, colour_cameras_, build_scene(world, colours_),
      LiveColoursOptions{context_.options.gl_device, context_.threads(), step,
                         [this](double done) { context_.progress.update(0, "light " + std::to_string(int(100 * done)) + " %"); }});
  colours_->restart(world);
}

void RobotSenses::note_step(const World& world) {
  if (ranges_) ranges_->note_step(world);
  if (readings_) readings_->note_step(world);
  if (colours_) colours_->note_step(world);
}

void RobotSenses::measure() {
  const auto hand_out = [&](const std::string& name, const auto& reading, auto list) {
    for (std::size_t i = 0; i < untold_.size(); ++i)
      if (senses(i, name)) (untold_[i].*list).push_back(reading);
  };
  LiveRanges::Readings readings = ranges_->take();
  for (const ImuSample& reading : readings_->take())
    hand_out(imu_names_[std::size_t(reading.sensor)], reading, &Untold::readings);
  for (LidarScan& scan : readings.scans) {
    const std::string& name = mission_.scenario.lidars[std::size_t(scan.sensor)].name;
    hand_out(name, std::make_shared<const LidarScan>(std::move(scan)), &Untold::scans);
  }
  for (SensedDepth& depth : readings.images) {
    const std::string& name = camera_names_[depth.camera];
    hand_out(name, std::make_shared<const SensedDepth>(std::move(depth)), &Untold::depths);
  }
  if (!colours_) return;
  for (SensedColours& colours : colours_->take()) {
    const std::string name = colour_sense(camera_names_[colours.camera]);
    hand_out(name, std::make_shared<const SensedColours>(std::move(colours)), &Untold::colours);
  }
}

void RobotSenses::tell(std::size_t robot, Value& told) {
  if (!ranges_) return;
  measure();
  const Scenario& scenario = mission_.scenario;
  Value lidars = Value::make_table(), cameras = Value::make_table(), images = Value::make_table();
  Value imus = Value::make_table();
  // Of several since the last call, the newest.
  for (const auto& scan : untold_[robot].scans) {
    const LidarScenario& lidar = scenario.lidars[std::size_t(scan->sensor)];
    lidars.set(lidar.name, describe_scan(*scan, lidar.spec(), scenario.start_ns));
  }
  for (const auto& depth : untold_[robot].depths)
    cameras.set(camera_names_[depth->camera], describe_depth(*depth, scenario.start_ns));
  for (const auto& colours : untold_[robot].colours)
    images.set(camera_names_[colours->camera], describe_colours(*colours, scenario.start_ns));
  for (std::size_t i = 0; i < imu_names_.size(); ++i) {
    Value list = describe_readings(untold_[robot].readings, int(i), scenario.start_ns);
    if (!list.items.empty()) imus.set(imu_names_[i], std::move(list));
  }
  told.set("lidars", std::move(lidars));
  told.set("cameras", std::move(cameras));
  told.set("images", std::move(images));
  told.set("imus", std::move(imus));
  untold_[robot] = {};
}

}  // namespace rubble
