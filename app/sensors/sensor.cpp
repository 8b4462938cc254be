#include "app/sensors/sensor.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "scripting/sky/sun_position.h"
#include "scripting/trajectory/imu.h"

namespace rubble {
namespace {

constexpr double kBostonLatitude = 42.36, kBostonLongitude = -71.06;  // unit: degree

std::vector<SensorSite::Hit> cast(RayWorld& world, const Vec3& from, const std::vector<Vec3>& directions, double range,
                                  std::int64_t stamp_ns) {
  if (world.moves()) world.span(stamp_ns, stamp_ns);
  std::vector<SensorSite::Hit> hits;
  hits.reserve(directions.size());
  RayWorld::Ray rays[RayWorld::kPacket];
  RayWorld::Hit met[RayWorld::kPacket];
  for (std::size_t first = 0; first < directions.size(); first += RayWorld::kPacket) {
    const std::size_t count = std::min(RayWorld::kPacket, directions.size() - first);
    for (std::size_t i = 0; i < count; ++i) rays[i] = {from, directions[first + i], 0};
    world.cast(rays, count, range, met);
    for (std::size_t i = 0; i < count; ++i) hits.push_back({met[i].distance, met[i].cosine, met[i].reflectance});
  }
  return hits;
}

// What is around the sensor of that number; way: of its carrier.
SensorSite make_site(const SensorParts& parts, std::size_t number, const std::shared_ptr<const MotionPath>& way) {
  const Scenario& scenario = parts.scenario;
  const SensorItem& sensor = scenario.sensors[number];
  SensorSite site;
  site.world_from_sensor = [way, carrier_from_sensor = sensor.carrier_from_sensor()](double t) { return way->at(t) * carrier_from_sensor; };
  site.start_ns = parts.start_ns;
  site.rays = parts.rays, site.air = parts.air, site.threads = parts.threads;
  site.seed = sensor.noise_seed(parts.noise_seed);
  site.cast = [place = site.world_from_sensor, world = parts.rays.get(), start = parts.start_ns](
                  double t, const std::vector<Vec3>& directions, double range) {
    return cast(*world, place(t).translation, directions, range, start + std::int64_t(t * 1e9 + 0.5));
  };
  site.contact_force = [&robots = parts.robots, number](const std::vector<std::string>&, double from, double to) {
    return robots.contacts.largest_force(robots.felt.at(number).robot, robots.felt[number].links, from, to);
  };
  site.motor_work = [&robots = parts.robots, number](double from, double to) {
    return robots.motors.work(robots.felt.at(number).robot, from, to);
  };
  const LightScenario& light = scenario.lights.front();
  site.north_deg = light.north_deg;
  site.latitude_deg = light.latitude_deg.value_or(kBostonLatitude);
  site.longitude_deg = light.longitude_deg.value_or(kBostonLongitude);
  site.utc_s = parts.start_ns / 1000000000;
  if (light.time) site.utc_s = parse_utc(*light.time).value_or(site.utc_s);
  return site;
}

// Of any kind of scripting/sensors.
class KindSensor : public Sensor {
 public:
  KindSensor(const SensorParts& parts, std::size_t number, const std::shared_ptr<const MotionPath>& way)
      : item_(parts.scenario.sensors[number]), number_(int(number)), start_ns_(parts.start_ns),
        timing_(item_.figures->timing(item_.rate())), site_(make_site(parts, number, way)),
        meter_(item_.start(site_, parts.noise_seed)) {}

  Needs needs() const override {
    Needs needs;
    needs.stamp = stamp_ns(next_);
    needs.end = timing_.lasts_a_period ? stamp_ns(next_ + 1) : needs.stamp;
    needs.from = needs.stamp - timing_.way_ns, needs.way_until = needs.end + timing_.way_ns;
    if (item_.figures->casts_rays()) needs.scene_until = needs.end + timing_.scene_ns;
    return needs;
  }
  Sample take() override {
    Reading reading{number_, stamp_ns(next_), meter_->read(double(next_) / item_.rate()), meter_->scan(next_)};
    ++next_;
    return reading;
  }

 private:
  std::int64_t stamp_ns(int k) const { return item_.stamp_ns(k, start_ns_); }

  SensorItem item_;
  int number_, next_ = 0;
  std::int64_t start_ns_;
  SensorTiming timing_;
  SensorSite site_;
  std::unique_ptr<SensorMeter> meter_;
};

class ImuSensor : public Sensor {
 public:
  ImuSensor(const SensorParts& parts, const ImuScenario& imu, int number, std::shared_ptr<const MotionPath> way)
      : way_(std::move(way)), number_(number), half_ns_(std::int64_t(std::ceil(0.5e9 / imu.model.rate_hz))),
        imu_(*way_, imu.model, parts.scenario.settle.gravity, seed_of(parts, imu), parts.start_ns,
             imu.is_rig() ? std::nullopt : std::optional(imu.rig_from_imu())) {}

  Needs needs() const override {
    const std::int64_t stamp = imu_.next_stamp();
    return {stamp, stamp, stamp - half_ns_, stamp + half_ns_};
  }
  Sample take() override {
    ImuSample sample = imu_.take();
    sample.sensor = number_;
    return sample;
  }

 private:
  // Each unit with a name has noise of its own.
  static std::uint64_t seed_of(const SensorParts& parts, const ImuScenario& imu) {
    return imu.named ? RandomStream(parts.noise_seed, "imus/" + imu.name).next() : parts.noise_seed;
  }

  std::shared_ptr<const MotionPath> way_;
  int number_;
  std::int64_t half_ns_;  // of its period
  Imu imu_;
};

}  // namespace

bool is_over(const Sensor::Needs& next, std::int64_t last_ns, bool taken) {
  constexpr std::int64_t kRounding = 1000;  // of stamps; unit: ns
  if (next.end == next.stamp) return next.stamp > last_ns;
  return next.end - kRounding > last_ns && (taken || next.stamp > last_ns);
}

const std::shared_ptr<const MotionPath>& SensorParts::way_of(const Carrier& carrier, const std::string& key) const {
  const std::shared_ptr<const MotionPath>& way = robots.path_of(carrier, rig);
  if (way) return way;
  throw InputError({"", 0, key, "no robot carries it", "`ride`, or `trajectory.ride` for the rig that it is on", "", ""});
}

std::unique_ptr<Sensor> make_imu(const SensorParts& parts, std::size_t number) {
  const ImuScenario& imu = parts.scenario.imus.at(number);
  return std::make_unique<ImuSensor>(parts, imu, int(number), parts.way_of(imu.ride, imu.key()));
}

std::unique_ptr<Sensor> make_sensor(const SensorParts& parts, std::size_t number) {
  const SensorItem& sensor = parts.scenario.sensors.at(number);
  return std::make_unique<KindSensor>(parts, number, parts.way_of(sensor.ride, sensor.key()));
}

}  // namespace rubble
