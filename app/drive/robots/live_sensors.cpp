#include "app/drive/robots/live_sensors.h"

#include <algorithm>
#include <utility>

namespace rubble {

LiveSensors::LiveSensors(const Scenario& scenario, const std::vector<MissionRobot>& robots,
                         std::unique_ptr<LiveRanges> ranges, std::unique_ptr<LiveImus> imus)
    : scenario_(scenario), robots_(robots), ranges_(std::move(ranges)), imus_(std::move(imus)) {}

void LiveSensors::restart(const World& world) {
  logs_.clear();
  for (std::size_t i = 0; i < robots_.size(); ++i)
    logs_.emplace_back(robots_[i].model, scenario_.start_ns, odometry_noise(scenario_, i));
  ranges_->restart(world);
  imus_->restart(world);
}

void LiveSensors::note_step(const World& world) {
  ranges_->note_step(world);
  imus_->note_step(world);
}

std::vector<Sample> LiveSensors::take() {
  std::vector<Sample> samples;
  for (RobotLog& log : logs_)
    for (RobotSample& sample : log.take_samples()) samples.emplace_back(std::move(sample));
  for (ImuSample& reading : imus_->take()) samples.emplace_back(reading);
  for (LidarScan& scan : ranges_->take().scans) samples.emplace_back(std::move(scan));
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
  return samples;
}

}  // namespace rubble
