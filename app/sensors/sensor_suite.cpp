#include "app/sensors/sensor_suite.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "app/sensors/camera_sensor.h"

namespace rubble {
namespace {

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

// The first stamp of readings at this rate that is not before that one.
std::int64_t stamp_from(std::int64_t at_ns, std::int64_t start_ns, double rate_hz) {
  const auto stamp = [&](double k) { return start_ns + std::int64_t(std::floor(k * 1e9 / rate_hz + 0.5)); };
  double k = std::floor(double(at_ns - start_ns) * 1e-9 * rate_hz);
  while (stamp(k) < at_ns) ++k;
  return stamp(k);
}

std::int64_t stamp_from(std::int64_t at_ns, const std::vector<RobotSample>& samples) {
  const auto first = std::find_if(samples.begin(), samples.end(), [&](const RobotSample& s) { return s.stamp_ns >= at_ns; });
  return first == samples.end() ? at_ns : first->stamp_ns;
}

}  // namespace

SensorSuite::SensorSuite(const Scenario& scenario, const RigFlight& flight, const SensorBegin& begin,
                         const Scene& scene, CameraRenderers& renderers, int threads,
                         const RobotReadings& robots) {
  const bool rays = casts_rays(scenario.sensors);
  const SensorParts parts{scenario, begin.noise_seed, flight.start_ns, robots, flight.path, rays ? std::make_shared<RayWorld>(scene) : nullptr,
                          std::make_shared<const Medium>(renderers.medium()), threads};
  std::int64_t last_ns = 0;
  for (const Flight& camera : flight.cameras) {
    frames_.push_back(int(camera.stamps_ns.size()));
    if (!camera.stamps_ns.empty()) last_ns = std::max(last_ns, camera.stamps_ns.back());
  }
  const auto add = [this](std::unique_ptr<Sensor> sensor, std::int64_t last) { members_.push_back({std::move(sensor), last}); };
  const auto is_there = [&](const Carrier& carrier) { return robots.path_of(carrier, flight.path) != nullptr; };
  const auto end_of = [&](const Carrier& carrier, std::int64_t last) {
    return robots.end_of(carrier, flight.path, flight.start_ns, last);
  };
  std::vector<Member> others;
  std::int64_t whole_ns = last_ns;  // the end of all scans; where the flight is too short for one, that of the first
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    const SensorItem& item = scenario.sensors[i];
    if (!is_there(item.ride)) continue;
    const bool sees = item.figures->casts_rays();
    others.push_back({make_sensor(parts, i), end_of(item.ride, begin.followed && !sees ? INT64_MAX : last_ns)});
    if (sees) whole_ns = std::max(whole_ns, others.back().sensor->needs().end);
  }
  for (const std::vector<RobotSample>& samples : robots.samples)
    add(std::make_unique<RobotSensor>(samples), stamp_from(last_ns, samples));
  for (std::size_t i = 0; i < scenario.imus.size(); ++i) {
    const ImuScenario& imu = scenario.imus[i];
    if (!is_there(imu.ride)) continue;
    const std::int64_t end = stamp_from(whole_ns, flight.start_ns, imu.model.rate_hz);
    // What carries it stands after its way.
    add(make_imu(parts, i), begin.followed ? end_of(imu.ride, INT64_MAX) : whole_ns > last_ns ? end : end_of(imu.ride, end));
  }
  std::move(others.begin(), others.end(), std::back_inserter(members_));
  for (std::size_t i = 0; i < flight.cameras.size(); ++i)
    if (is_there(scenario.cameras[i].ride))
      add(make_flown_camera(parts, i, flight, begin.frames.empty() ? 0 : begin.frames[i], renderers.of(i)), last_ns);
}

int SensorSuite::count_frames() const { return std::accumulate(frames_.begin(), frames_.end(), 0); }

std::optional<Sample> SensorSuite::take() {
  Member* first = nullptr;
  std::int64_t stamp = INT64_MAX;
  for (Member& member : members_) {
    const Sensor::Needs next = member.sensor->needs();
    if (next.stamp < stamp && !is_over(next, member.last_ns, member.taken)) first = &member, stamp = next.stamp;
  }
  if (!first) return std::nullopt;
  first->taken = true;
  return first->sensor->take();
}

}  // namespace rubble
