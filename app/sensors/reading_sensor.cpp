#include "app/sensors/reading_sensor.h"

#include <algorithm>

#include "scripting/sky/sun_position.h"

namespace rubble {
namespace {

constexpr double kBostonLatitude = 42.36, kBostonLongitude = -71.06;  // unit: degree

std::vector<SensorSite::Hit> cast(LidarWorld& world, const Vec3& from, const std::vector<Vec3>& directions, double range,
                                  std::int64_t stamp_ns) {
  if (world.moves()) world.span(stamp_ns, stamp_ns);
  std::vector<SensorSite::Hit> hits;
  hits.reserve(directions.size());
  LidarWorld::Ray rays[LidarWorld::kPacket];
  LidarWorld::Hit met[LidarWorld::kPacket];
  for (std::size_t first = 0; first < directions.size(); first += LidarWorld::kPacket) {
    const std::size_t count = std::min(LidarWorld::kPacket, directions.size() - first);
    for (std::size_t i = 0; i < count; ++i) rays[i] = {from, directions[first + i], 0};
    world.cast(rays, count, range, met);
    for (std::size_t i = 0; i < count; ++i) hits.push_back({met[i].distance, met[i].cosine, met[i].reflectance});
  }
  return hits;
}

}  // namespace

SensorSite make_sensor_site(const Scenario& scenario, std::int64_t start_ns, const SensorItem& sensor, const MotionPath& path, LidarWorld* world,
                            std::function<double(const std::vector<std::string>&, double, double)> forces) {
  SensorSite site;
  const Pose carrier_from_sensor = sensor.carrier_from_sensor();
  site.world_from_sensor = [&path, carrier_from_sensor](double t) { return path.at(t) * carrier_from_sensor; };
  site.cast = [place = site.world_from_sensor, world, start = start_ns](double t, const std::vector<Vec3>& directions, double range) {
    return cast(*world, place(t).translation, directions, range, start + std::int64_t(t * 1e9 + 0.5));
  };
  site.contact_force = std::move(forces);
  const LightScenario& light = scenario.lights.front();
  site.north_deg = light.north_deg;
  site.latitude_deg = light.latitude_deg.value_or(kBostonLatitude);
  site.longitude_deg = light.longitude_deg.value_or(kBostonLongitude);
  site.utc_s = start_ns / 1000000000;
  if (light.time) site.utc_s = parse_utc(*light.time).value_or(site.utc_s);
  return site;
}

std::function<double(const std::vector<std::string>&, double, double)> forces_of(const RobotReadings& robots,
                                                                                 std::size_t number) {
  return [&robots, number](const std::vector<std::string>&, double from, double to) {
    return robots.contacts.largest_force(robots.felt.at(number).robot, robots.felt[number].links, from, to);
  };
}

bool needs_rays(const std::vector<SensorItem>& sensors) {
  return std::any_of(sensors.begin(), sensors.end(), [](const SensorItem& s) { return s.figures->casts_rays(); });
}

ReadingSensor::ReadingSensor(const Scenario& scenario, int number, std::uint64_t noise_seed, std::int64_t start_ns, std::int64_t last_ns,
                             std::shared_ptr<const MotionPath> path, std::shared_ptr<LidarWorld> world,
                             std::function<double(const std::vector<std::string>&, double, double)> forces)
    : item_(scenario.sensors[std::size_t(number)]), number_(number), start_ns_(start_ns), last_ns_(last_ns),
      path_(std::move(path)), world_(std::move(world)),
      site_(make_sensor_site(scenario, start_ns, item_, *path_, world_.get(), std::move(forces))), meter_(item_.start(site_, noise_seed)) {}

std::optional<std::int64_t> ReadingSensor::next_stamp() const {
  const std::int64_t stamp = item_.stamp_ns(next_, start_ns_);
  return stamp <= last_ns_ ? std::optional(stamp) : std::nullopt;
}

Sample ReadingSensor::take() {
  const double t = double(next_) / item_.rate_hz;
  return Reading{number_, item_.stamp_ns(next_++, start_ns_), meter_->read(t)};
}

}  // namespace rubble
