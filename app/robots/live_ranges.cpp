#include "app/robots/live_ranges.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/robots/ride_recorder.h"
#include "kernel/base/error.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

constexpr double kFarthestDepth = 1000;  // along a ray; unit: m

// `key` is that of the camera in the mission.
DepthRays make_depth_rays(const MountedCamera& camera, const std::string& key) {
  const Intrinsics k = camera.camera.intrinsics();
  const bool straight = std::all_of(k.distortion.begin(), k.distortion.end(), [](double d) { return d == 0; });
  if (camera.camera.lens.model == LensKind::fisheye || !straight)
    throw InputError({"", 0, key + ".lens", "a function can be told of no such camera",
                      "a pinhole", "a lens with distortion", "a camera of its own, without `lens`, can be sensed"});
  return DepthRays(k, kFarthestDepth);
}

}  // namespace

LinkMount find_link_mount(const Carrier& carrier, const std::optional<LinkMount>& rig, const std::string& key,
                          const std::vector<std::string>& names, const std::vector<MissionRobot>& robots) {
  if (!carrier.on()) {
    if (rig) return *rig;
    throw InputError({"", 0, key, "no robot carries it", "`ride`, or `trajectory.ride` for the rig that it is on", "", ""});
  }
  const auto robot = std::size_t(std::find(names.begin(), names.end(), carrier.robot) - names.begin());
  const RiddenLink ridden = find_ridden_link(robots[robot], carrier, key + ".ride");
  return {robot, ridden.link, ridden.link_from_rider};
}

LiveRanges::LiveRanges(const Scenario& scenario, const std::vector<RidingSensor>& lidars,
                       const std::vector<RidingSensor>& cameras, const Scene& scene, const Medium& medium,
                       double step, int threads)
    : scenario_(scenario), step_(step), pool_(threads) {
  if (lidars.empty() && cameras.empty()) return;
  world_ = std::make_shared<LidarWorld>(scene);
  for (const RidingSensor& at : lidars) {
    Scanner& scanner = *scanners_.emplace_back(std::make_unique<Scanner>());
    scanner.at = at;
    const LidarScenario& lidar = scenario.lidars[at.number];
    const auto place = [this, &scanner, carrier_from_lidar = lidar.rig_from_lidar()](std::int64_t stamp_ns) {
      return pose_at(scanner, stamp_ns) * carrier_from_lidar;
    };
    // As the sensor that records: the same noise.
    const std::uint64_t seed = RandomStream(scenario.seed, "lidars/" + lidar.name).next();
    scanner.lidar = std::make_unique<Lidar>(lidar.spec(), world_, LidarPlace{place, scenario.start_ns}, medium, seed,
                                            threads);
  }
  const std::vector<MountedCamera> all = all_cameras(scenario);
  for (const RidingSensor& at : cameras) {
    const MountedCamera& camera = all[at.number];
    const std::string key = scenario.cameras.empty() ? "camera" : "cameras." + camera.name;
    imagers_.push_back(std::make_unique<Imager>(Imager{{at, {}, {}, 0}, make_depth_rays(camera, key),
                                                       camera.rate_hz.value_or(scenario.trajectory.rate_hz),
                                                       camera.rig_from_camera()}));
  }
}

std::int64_t LiveRanges::Imager::stamp_ns(int image, std::int64_t start_ns) const {
  return start_ns + std::int64_t(std::floor(double(image) * 1e9 / rate_hz + 0.5));
}

double LiveRanges::since_start(std::int64_t stamp_ns) const {
  return double(stamp_ns - scenario_.start_ns) * 1e-9;
}

Pose LiveRanges::pose_at(const Rider& rider, std::int64_t stamp_ns) const {
  return rider.way->at(since_start(stamp_ns));
}

// Up to there, and some rays beyond, the curve through the steps is the one that it will be.
std::int64_t LiveRanges::known_until() const {
  return scenario_.start_ns + std::int64_t(double(steps_ - 2) * step_ * 1e9);
}

void LiveRanges::restart(const World& world) {
  for (const auto& scanner : scanners_) scanner->next = 0, scanner->poses.clear();
  for (const auto& imager : imagers_) imager->next = 0, imager->poses.clear();
  poses_.clear();
  first_ = 0, steps_ = -1;
  note_step(world);
}

void LiveRanges::note_step(const World& world) {
  ++steps_;
  if (empty()) return;
  std::vector<std::optional<Pose>>& poses = poses_.emplace_back(std::size_t(world.size()));
  for (int id = 0; id < world.size(); ++id) {
    const PieceState piece = world.piece(id);
    if (piece.status != PieceStatus::lost) poses[std::size_t(id)] = piece.world_from_body;
  }
  const auto note = [&](Rider& rider) {
    const LinkMount& mount = rider.at.mount;
    const int link = world.robot_piece(int(mount.robot)) + int(mount.link);
    rider.poses.push_back(world.piece(link).world_from_body * mount.link_from_carrier);
  };
  for (const auto& scanner : scanners_) note(*scanner);
  for (const auto& imager : imagers_) note(*imager);
}

std::optional<Pose> LiveRanges::pose_of(int id, std::int64_t stamp_ns) const {
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

void LiveRanges::begin_way(Rider& rider) {
  rider.way = std::make_unique<SimulatedPath>(rider.poses, step_, first_);
  measuring_ = true;
}

void LiveRanges::scan(Scanner& scanner, std::vector<LidarScan>& scans) {
  const std::int64_t until = known_until();
  if (scanner.lidar->stamp_ns(scanner.next + 1) > until) return;
  begin_way(scanner);
  while (scanner.lidar->stamp_ns(scanner.next + 1) <= until) {
    scans.push_back(scanner.lidar->take(scanner.next++));
    scans.back().sensor = int(scanner.at.number);
  }
  measuring_ = false;
}

void LiveRanges::look(Imager& imager, std::vector<SensedDepth>& images) {
  const std::int64_t until = known_until();
  if (imager.stamp_ns(imager.next, scenario_.start_ns) > until) return;
  begin_way(imager);
  for (std::int64_t stamp; (stamp = imager.stamp_ns(imager.next, scenario_.start_ns)) <= until; ++imager.next) {
    const Intrinsics& k = imager.rays.intrinsics();
    SensedDepth& image = images.emplace_back();
    image = {stamp, imager.at.number, k.width, k.height, std::vector<float>(std::size_t(k.width) * std::size_t(k.height))};
    if (world_->moves()) world_->span(stamp, stamp);
    imager.rays.cast(*world_, pose_at(imager, stamp) * imager.carrier_from_camera, pool_, image.depth.data());
  }
  measuring_ = false;
}

LiveRanges::Readings LiveRanges::take() {
  Readings readings;
  for (const auto& scanner : scanners_) scan(*scanner, readings.scans);
  for (const auto& imager : imagers_) look(*imager, readings.images);
  forget();
  return readings;
}

// What nothing needs any more. The curve between two steps needs the steps beside them.
void LiveRanges::forget() {
  std::int64_t keep = steps_ - 4;
  const auto need = [&](std::int64_t stamp_ns) {
    keep = std::min(keep, std::int64_t(std::floor(since_start(stamp_ns) / step_)) - 2);
  };
  for (const auto& scanner : scanners_) need(scanner->lidar->stamp_ns(scanner->next));
  for (const auto& imager : imagers_) need(imager->stamp_ns(imager->next, scenario_.start_ns));
  const std::int64_t gone = keep - first_;
  if (empty() || gone <= 0) return;
  poses_.erase(poses_.begin(), poses_.begin() + gone);
  for (const auto& scanner : scanners_) scanner->poses.erase(scanner->poses.begin(), scanner->poses.begin() + gone);
  for (const auto& imager : imagers_) imager->poses.erase(imager->poses.begin(), imager->poses.begin() + gone);
  first_ = keep;
}

}  // namespace rubble
