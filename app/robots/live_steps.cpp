#include "app/robots/live_steps.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"

namespace rubble {

LinkMount find_link_mount(const Carrier& carrier, const std::optional<LinkMount>& rig, const std::string& key,
                          const std::vector<std::string>& names, const std::vector<MissionRobot>& robots) {
  if (!carrier.on()) {
    if (rig) return *rig;
    throw InputError({"", 0, key, "no robot carries it", "`ride`, or `trajectory.ride` for the rig that it is on", "", ""});
  }
  const auto robot = std::size_t(std::find(names.begin(), names.end(), carrier.robot) - names.begin());
  const RiddenLink ridden = find_link(robots[robot], carrier.link, key + ".ride");
  return {robot, ridden.link, ridden.link_from_rider};
}

std::size_t LiveSteps::add_carrier(const LinkMount& mount) {
  riders_.push_back({mount, {}});
  return riders_.size() - 1;
}

void LiveSteps::restart(const World& world) {
  for (Rider& rider : riders_) rider.poses.clear();
  poses_.clear();
  first_ = 0, steps_ = -1;
  note_step(world);
}

void LiveSteps::note_step(const World& world) {
  ++steps_;
  if (riders_.empty()) return;
  std::vector<std::optional<Pose>>& poses = poses_.emplace_back(std::size_t(world.size()));
  for (int id = 0; id < world.size(); ++id) {
    const PieceState piece = world.piece(id);
    if (piece.status != PieceStatus::lost) poses[std::size_t(id)] = piece.world_from_body;
  }
  for (Rider& rider : riders_) {
    const int link = world.robot_piece(int(rider.mount.robot)) + int(rider.mount.link);
    rider.poses.push_back(world.piece(link).world_from_body * rider.mount.link_from_carrier);
  }
}

std::int64_t LiveSteps::known_until() const {
  return start_ns_ + std::int64_t(double(steps_ - 2) * step_ * 1e9);
}

void LiveSteps::begin_measuring(std::size_t carrier) {
  way_ = std::make_unique<SimulatedPath>(riders_[carrier].poses, step_, first_);
}

Pose LiveSteps::carrier_after(double seconds) const { return way_->at(seconds); }

CameraMotion LiveSteps::carrier_motion_after(double seconds) const { return way_->motion_at(seconds); }

std::optional<Pose> LiveSteps::pose_of(int id, std::int64_t stamp_ns) const {
  const double at = std::clamp(since_start(stamp_ns) / step_ - double(first_), 0.0, double(poses_.size() - 1));
  const auto before = std::size_t(at), after = std::min(before + 1, poses_.size() - 1);
  const std::optional<Pose>&a = poses_[before][std::size_t(id)], &b = poses_[after][std::size_t(id)];
  if (!a || !b) return std::nullopt;
  const double v = at - double(before), u = 1 - v;
  const Quat &p = a->rotation, &q = b->rotation;
  const double w = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -v : v;
  return Pose{normalized(Quat(p.w * u + q.w * w, p.x * u + q.x * w, p.y * u + q.y * w, p.z * u + q.z * w)),
              a->translation * u + b->translation * v};
}

void LiveSteps::forget_before(std::int64_t stamp_ns) {
  if (riders_.empty()) return;
  const std::int64_t keep = std::min(steps_ - 4, std::int64_t(std::floor(since_start(stamp_ns) / step_)) - 2);
  const std::int64_t gone = keep - first_;
  if (gone <= 0) return;
  poses_.erase(poses_.begin(), poses_.begin() + gone);
  for (Rider& rider : riders_) rider.poses.erase(rider.poses.begin(), rider.poses.begin() + gone);
  first_ = keep;
}

}  // namespace rubble
