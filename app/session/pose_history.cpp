#include "app/session/pose_history.h"

#include <algorithm>
#include <cmath>

#include "app/robots/link_sensors.h"
#include "app/scene/moving_scene.h"
#include "kernel/base/error.h"
#include "kernel/world/world_robots.h"

namespace rubble {
namespace {

bool any_feels(const std::vector<SensorItem>& sensors, bool (SensorKind::*what)() const) {
  return std::any_of(sensors.begin(), sensors.end(), [&](const SensorItem& s) { return ((*s.figures).*what)(); });
}

}  // namespace

PoseHistory::PoseHistory(const Scenario& scenario, const std::vector<MissionRobot>& robots, double step,
                         std::int64_t start_ns)
    : names_(robot_names(scenario.robots)), robots_(robots), start_ns_(start_ns), step_(step),
      felt_(any_feels(scenario.sensors, &SensorKind::feels_contacts)), driven_(any_feels(scenario.sensors, &SensorKind::feels_motors)) {
  const auto add_link = [&](const Carrier& carrier, const std::string& key) {
    const auto same = [&](const LinkWay& link) { return link.carrier == carrier; };
    if (!carrier.on() || std::any_of(ways_.links.begin(), ways_.links.end(), same)) return;
    add(carrier, {}, key);
    ways_.links.push_back({carrier, mounts_.back().way});
  };
  const Ride& rig = scenario.trajectory.ride;
  if (rig.on()) {
    add(rig, rig.link_from_rig(), "trajectory.ride");
    rig_ = 0;
    ways_.ride = mounts_.back().way;
  }
  for (const MountedCamera& camera : scenario.cameras) add_link(camera.ride, camera.key() + ".ride");
  for (const ImuScenario& imu : scenario.imus) add_link(imu.ride, imu.key() + ".ride");
  for (const SensorItem& sensor : scenario.sensors) add_link(sensor.ride, sensor.key() + ".ride");
  ways_.felt = find_felt_links(scenario, robots);
}

void PoseHistory::add(const Carrier& carrier, const Pose& link_from_carrier, const std::string& key) {
  Mount mount;
  mount.robot = std::size_t(std::find(names_.begin(), names_.end(), carrier.robot) - names_.begin());
  static_cast<RiddenLink&>(mount) = find_link(robots_[mount.robot], carrier.link, key);
  mount.link_from_rider = mount.link_from_rider * link_from_carrier;
  mount.way = std::make_shared<SimulatedPath>(step_);
  mounts_.push_back(std::move(mount));
}

PieceState PoseHistory::state_of(const Mount& mount) const {
  const World& world = run_->world();
  return world.piece(world.robots().first_piece(int(mount.robot)) + int(mount.link));
}

Pose PoseHistory::place(const Mount& mount) const { return state_of(mount).world_from_body * mount.link_from_rider; }

Pose PoseHistory::world_from_rig() const { return place(mounts_.at(std::size_t(rig_))); }

// The rig comes first, then the links in their order.
const PoseHistory::Mount* PoseHistory::find(const Carrier& carrier) const {
  const std::size_t rigs = rig_ < 0 ? 0 : 1;
  if (!carrier.on()) return rigs == 0 ? nullptr : &mounts_[0];
  for (std::size_t i = 0; i < ways_.links.size(); ++i)
    if (ways_.links[i].carrier == carrier) return &mounts_[rigs + i];
  return nullptr;
}

std::optional<Pose> PoseHistory::world_from(const Carrier& carrier) const {
  const Mount* const mount = find(carrier);
  return mount ? std::optional(place(*mount)) : std::nullopt;
}

std::optional<std::int64_t> PoseHistory::end_of(const Carrier& carrier) const {
  const Mount* const mount = find(carrier);
  if (!mount || !mount->lost) return std::nullopt;
  return ways_.end_of(carrier, ways_.ride, start_ns_, INT64_MAX);
}

std::optional<RigMount> PoseHistory::mount(const std::vector<RobotRecord>& records) const {
  if (rig_ < 0) return std::nullopt;
  const Mount& rig = mounts_[std::size_t(rig_)];
  return RigMount{records[rig.robot].frame_of(int(rig.link)), rig.link_from_rider};
}

void PoseHistory::restart(const RobotRun& run) {
  run_ = &run;
  for (Mount& mount : mounts_) mount.way->clear(), mount.lost = false;
  for (Mount& mount : mounts_) mount.way->add(place(mount));
  ways_.contacts = ContactHistory(step_);
  ways_.motors = MotorHistory(step_);
}

void PoseHistory::note_step() {
  for (Mount& mount : mounts_) {
    const PieceState link = state_of(mount);
    mount.lost = link.status == PieceStatus::lost;
    // A way has two poses at least: of a link that is lost in the first step both are that of its start.
    if (!mount.lost || run_->steps() == 1) mount.way->add(link.world_from_body * mount.link_from_rider);
  }
  if (felt_) ways_.contacts.note(run_->world(), int(robots_.size()));
  if (driven_) ways_.motors.note(run_->world(), int(robots_.size()));
}

std::int64_t PoseHistory::ways_known_until() const {
  return start_ns_ + std::int64_t(double(run_->steps() - 2) * step_ * 1e9);
}

// Less what rounding may add.
std::int64_t PoseHistory::track_known_until() const { return start_ns_ + std::int64_t(run_->track().end() * 1e9) - 1; }

std::optional<Pose> PoseHistory::pose_of(int id, std::int64_t stamp_ns) const {
  return pose_in_track(run_->track(), id, stamp_ns - start_ns_);
}

// The curve between two steps needs the steps beside them.
void PoseHistory::forget_before(std::int64_t stamp_ns) {
  const double seconds = double(stamp_ns - start_ns_) * 1e-9;
  for (Mount& mount : mounts_) mount.way->forget_before(std::int64_t(std::floor(seconds / step_)) - 2);
}

}  // namespace rubble
