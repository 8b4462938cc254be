#include "app/drive/robots/live_sensors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/base/random.h"

namespace rubble {

LiveSensors::LiveSensors(const Scenario& scenario, const std::vector<MissionRobot>& robots,
                         std::vector<LidarMount> mounts, const Scene& scene, const Medium& medium, double step,
                         int threads)
    : scenario_(scenario), robots_(robots), step_(step) {
  if (mounts.empty()) return;
  const auto world = std::make_shared<LidarWorld>(scene);
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    scanners_.push_back(std::make_unique<Scanner>());
    Scanner& scanner = *scanners_.back();
    scanner.mount = mounts[i];
    const auto at = [this, &scanner](std::int64_t stamp_ns) { return scanner.way->at(since_first(stamp_ns)); };
    const std::uint64_t seed = RandomStream(scenario.seed, "live_lidars/" + scenario.lidars[i].name).next();
    scanner.lidar = std::make_unique<Lidar>(scenario.lidars[i].spec(), world, LidarPlace{at, scenario.start_ns}, medium,
                                            seed, threads);
  }
}

double LiveSensors::since_first(std::int64_t stamp_ns) const {
  return double(stamp_ns - scenario_.start_ns) * 1e-9 - double(first_) * step_;
}

void LiveSensors::restart(const World& world) {
  logs_.clear();
  for (std::size_t i = 0; i < robots_.size(); ++i) logs_.emplace_back(robots_[i].model, int(i), scenario_.start_ns);
  for (const auto& scanner : scanners_) scanner->next = 0;
  poses_.clear();
  ways_.assign(scanners_.size(), {});
  first_ = 0, steps_ = -1;
  note_step(world);
}

void LiveSensors::note_step(const World& world) {
  ++steps_;
  if (scanners_.empty()) return;
  std::vector<std::optional<Pose>>& poses = poses_.emplace_back(std::size_t(world.size()));
  for (int id = 0; id < world.size(); ++id) {
    const PieceState piece = world.piece(id);
    if (piece.status != PieceStatus::lost) poses[std::size_t(id)] = piece.world_from_body;
  }
  for (std::size_t i = 0; i < scanners_.size(); ++i) {
    const LidarMount& mount = scanners_[i]->mount;
    const int link = world.robot_piece(int(mount.robot)) + int(mount.link);
    ways_[i].push_back(world.piece(link).world_from_body * mount.link_from_lidar);
  }
}

std::optional<Pose> LiveSensors::pose_of(int id, std::int64_t stamp_ns) const {
  const double at = std::clamp(since_first(stamp_ns) / step_, 0.0, double(poses_.size() - 1));
  const auto before = std::size_t(at), after = std::min(before + 1, poses_.size() - 1);
  const std::optional<Pose>&a = poses_[before][std::size_t(id)], &b = poses_[after][std::size_t(id)];
  if (!a || !b) return std::nullopt;
  const double v = at - double(before), u = 1 - v;
  const Quat &p = a->rotation, &q = b->rotation;
  const double w = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -v : v;
  return Pose{normalized(Quat(p.w * u + q.w * w, p.x * u + q.x * w, p.y * u + q.y * w, p.z * u + q.z * w)),
              a->translation * u + b->translation * v};
}

void LiveSensors::scan(Scanner& scanner, int number, std::vector<Sample>& samples) {
  const std::int64_t now = scenario_.start_ns + std::int64_t(double(steps_) * step_ * 1e9);
  if (scanner.lidar->stamp_ns(scanner.next + 1) > now) return;
  scanner.way = std::make_unique<SimulatedPath>(ways_[std::size_t(number)], step_);
  scanning_ = true;
  while (scanner.lidar->stamp_ns(scanner.next + 1) <= now) {
    LidarScan scan = scanner.lidar->take(scanner.next++);
    scan.sensor = number;
    samples.push_back(std::move(scan));
  }
  scanning_ = false;
}

// What no scan needs any more. The curve between two steps needs the steps beside them.
void LiveSensors::forget() {
  std::int64_t keep = steps_ - 1;
  for (const auto& scanner : scanners_) {
    const double begin = double(scanner->lidar->stamp_ns(scanner->next) - scenario_.start_ns) * 1e-9;
    keep = std::min(keep, std::int64_t(std::floor(begin / step_)) - 1);
  }
  const std::int64_t gone = keep - first_;
  if (scanners_.empty() || gone <= 0) return;
  poses_.erase(poses_.begin(), poses_.begin() + gone);
  for (std::vector<Pose>& way : ways_) way.erase(way.begin(), way.begin() + gone);
  first_ = keep;
}

std::vector<Sample> LiveSensors::take() {
  std::vector<Sample> samples;
  for (RobotLog& log : logs_)
    for (RobotSample& sample : log.take_samples()) samples.push_back(std::move(sample));
  for (std::size_t i = 0; i < scanners_.size(); ++i) scan(*scanners_[i], int(i), samples);
  forget();
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
  return samples;
}

}  // namespace rubble
