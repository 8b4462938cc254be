#include "app/sensors/sensor_suite.h"

#include <algorithm>
#include <numeric>

#include "app/sensors/camera_sensor.h"

namespace rubble {
namespace {

constexpr std::int64_t kRounding = 1000;  // of stamps; unit: ns

// What a robot sensed when it was driven.
class RobotSensor : public Sensor {
 public:
  explicit RobotSensor(const std::vector<RobotSample>& samples) : samples_(samples) {}

  Needs needs() const override {
    Needs needs;
    needs.stamp = needs.end = next_ < samples_.size() ? samples_[next_].stamp_ns : INT64_MAX;
    return needs;
  }
  Sample take() override { return samples_[next_++]; }

 private:
  const std::vector<RobotSample>& samples_;
  std::size_t next_ = 0;
};

}  // namespace

SensorSuite::SensorSuite(const Scenario& flown, const RigFlight& flight, const SensorBegin& begin,
                         const Scene& scene, Renderer& renderer, int threads,
                         const RobotReadings& robots) {
  const bool rays = casts_rays(flown.sensors);
  const SensorParts parts{flown, begin.noise_seed, robots, flight.path, rays ? std::make_shared<RayWorld>(scene) : nullptr,
                          std::make_shared<const Medium>(renderer.medium()), threads};
  std::int64_t last_ns = 0;
  for (const Flight& camera : flight.cameras) {
    frames_.push_back(int(camera.stamps_ns.size()));
    last_ns = std::max(last_ns, camera.stamps_ns.back());
  }
  const auto add = [this](std::unique_ptr<Sensor> sensor, std::int64_t last) { members_.push_back({std::move(sensor), last}); };
  for (const std::vector<RobotSample>& samples : robots.samples) add(std::make_unique<RobotSensor>(samples), last_ns);
  const std::vector<ImuScenario> imus = all_imus(flown);
  for (std::size_t i = 0; i < imus.size(); ++i) add(make_imu(parts, i), robots.end_of(imus[i].ride, flown.start_ns, last_ns));
  for (std::size_t i = 0; i < flown.sensors.size(); ++i)
    add(make_sensor(parts, i), robots.end_of(flown.sensors[i].ride, flown.start_ns, last_ns));
  for (std::size_t i = 0; i < flight.cameras.size(); ++i)
    add(make_flown_camera(parts, i, flight, begin.frames.empty() ? 0 : begin.frames[i], renderer), last_ns);
}

int SensorSuite::count_frames() const { return std::accumulate(frames_.begin(), frames_.end(), 0); }

// Whole scans, as other streams end with the last frame; where none fits, one all the same.
bool SensorSuite::Member::is_over(const Sensor::Needs& next) const {
  if (next.end == next.stamp) return next.stamp > last_ns;
  return next.end > last_ns + kRounding && (taken || next.stamp > last_ns);
}

std::optional<Sample> SensorSuite::take() {
  Member* first = nullptr;
  std::int64_t stamp = INT64_MAX;
  for (Member& member : members_) {
    const Sensor::Needs next = member.sensor->needs();
    if (next.stamp < stamp && !member.is_over(next)) first = &member, stamp = next.stamp;
  }
  if (!first) return std::nullopt;
  first->taken = true;
  return first->sensor->take();
}

}  // namespace rubble
