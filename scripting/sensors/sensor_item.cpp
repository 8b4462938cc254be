#include "scripting/sensors/sensor_item.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

// Numbers among all sensors of those of one kind.
std::vector<std::size_t> find_kin(const std::vector<SensorItem>& sensors, const std::string& key) {
  std::vector<std::size_t> kin;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (sensors[i].figures->key() == key) kin.push_back(i);
  return kin;
}

// Kinds keep their order, and sensors of a kind theirs.
void reset_kin(std::vector<SensorItem>& sensors, const SensorKind& kind, const std::vector<std::string>& names) {
  std::vector<SensorItem> all;
  for (const SensorKind* other : sensor_kinds()) {
    if (other->key() == kind.key())
      for (const std::string& name : names) all.emplace_back(kind, name);
    else
      for (const std::size_t i : find_kin(sensors, other->key())) all.push_back(sensors[i]);
  }
  sensors = std::move(all);
}

Schema sensor_schema(SensorItem& sensor) {
  Schema k;
  sensor.figures->add_model_key(k);
  k.group("ride", "Link of a robot that carries the sensor, instead of the rig.");
  k.value("ride.robot", sensor.ride.robot, "Name of the robot.");
  k.value("ride.link", sensor.ride.link, "Link of the robot; not given: the first link.");
  k.value("position", sensor.position, "Position on the rig, or on the link of `ride`: X forward, Y left, Z up.")
      .between(-10, 10)
      .unit("m");
  k.value("rpy_deg", sensor.rpy_deg, "Orientation in the same frame: roll, pitch (positive: down), yaw.")
      .between(-360, 360)
      .unit("degree");
  if (!sensor.figures->own_rate_hz()) k.value("rate_hz", sensor.rate_hz, "Readings per second.").between(0.01, 1000).unit("Hz");
  sensor.figures->add_keys(k);
  k.value("noise", sensor.noise, "false: exact readings.");
  k.value("topic", sensor.topic, "ROS topic; not given: `/NAME`, unless the kind has another.");
  k.value("frame_id", sensor.frame_id, "TF frame; not given: `NAME_link`.");
  return k;
}

}  // namespace

Pose SensorItem::carrier_from_sensor() const {
  constexpr double kRadians = portable::kPi / 180;
  return {portable::quat_from_rpy(rpy_deg.x * kRadians, rpy_deg.y * kRadians, rpy_deg.z * kRadians), position};
}

std::int64_t SensorItem::stamp_ns(std::int64_t k, std::int64_t start_ns) const {
  return start_ns + std::int64_t(std::floor(double(k) * 1e9 / rate() + 0.5));
}

std::uint64_t SensorItem::noise_seed(std::uint64_t mission_seed) const {
  return RandomStream(mission_seed, figures->key() + "/" + name).next();
}

std::unique_ptr<SensorMeter> SensorItem::start(const SensorSite& site, std::uint64_t mission_seed) const {
  return figures->start(site, noise ? std::optional(noise_seed(mission_seed)) : std::nullopt, rate());
}

std::string topic_of(const std::vector<SensorItem>& sensors, const SensorItem& sensor) {
  if (sensor.topic) return *sensor.topic;
  const std::string usual = sensor.figures->usual_topic();
  const auto kin = std::count_if(sensors.begin(), sensors.end(), [&](const SensorItem& other) {
    return !other.topic && other.figures->usual_topic() == usual;
  });
  return (!usual.empty() && kin == 1 ? "" : "/" + sensor.name) + usual;
}

bool casts_rays(const std::vector<SensorItem>& sensors) {
  return std::any_of(sensors.begin(), sensors.end(), [](const SensorItem& s) { return s.figures->casts_rays(); });
}

bool scans(const SensorItem& sensor) { return sensor.figures->most_points() > 0; }

void add_sensor_keys(Schema& keys, std::vector<SensorItem>& sensors) {
  for (const SensorKind* kind : sensor_kinds())
    keys.add(kind->key(),
             kind->doc() + " `" + kind->key() + " = { " + kind->example() + " = {} }` (docs/reference/sensors.md)." +
                 (kind == sensor_kinds().front() ? "" : " The keys of mount and names are those of `" + sensor_kinds().front()->key() + "`."),
             [&sensors, kind](std::size_t) {
               return NamedTables{[&sensors, kind] {
                                    std::vector<std::string> names;
                                    for (const std::size_t i : find_kin(sensors, kind->key())) names.push_back(sensors[i].name);
                                    return names;
                                  },
                                  [&sensors, kind](const std::vector<std::string>& names) { reset_kin(sensors, *kind, names); },
                                  [&sensors, kind](std::size_t i) {
                                    return sensor_schema(sensors[find_kin(sensors, kind->key()).at(i)]);
                                  },
                                  kind->example()};
             });
}

void check_sensors(const std::vector<SensorItem>& sensors, std::vector<Diagnostic>& mistakes) {
  for (const SensorItem& sensor : sensors) {
    if (sensor.figures->on_robots_only() && !sensor.ride.on())
      mistakes.push_back({"", 0, sensor.key() + ".ride", "a sensor of this kind must be on a robot", "`ride = { robot = NAME }`", "nothing", ""});
    for (Diagnostic& d : sensor.figures->find_mistakes()) {
      d.key = sensor.key() + (d.key.empty() ? "" : "." + d.key);
      mistakes.push_back(std::move(d));
    }
  }
}

}  // namespace rubble
