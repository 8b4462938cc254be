#include "app/drive/robots/live_sensors.h"

#include <algorithm>
#include <utility>

namespace rubble {

LiveSensors::LiveSensors(const Scenario& scenario, const std::vector<MissionRobot>& robots,
                         std::unique_ptr<LiveRanges> ranges)
    : robots_(robots), start_ns_(scenario.start_ns), ranges_(std::move(ranges)) {}

void LiveSensors::restart(const World& world) {
  logs_.clear();
  for (std::size_t i = 0; i < robots_.size(); ++i) logs_.emplace_back(robots_[i].model, int(i), start_ns_);
  ranges_->restart(world);
}

std::vector<Sample> LiveSensors::take() {
  std::vector<Sample> samples;
  for (RobotLog& log : logs_)
    for (RobotSample& sample : log.take_samples()) samples.push_back(std::move(sample));
  for (LidarScan& scan : ranges_->take().scans) samples.push_back(std::move(scan));
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
  return samples;
}

}  // namespace rubble
