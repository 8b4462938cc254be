// The sensors of a mission of all kinds that sensor_kinds() lists.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scripting/sensors/sensor_kind.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// A kind with the figures of one sensor; copied with them.
class SensorFigures {
 public:
  explicit SensorFigures(const SensorKind& kind) : kind_(kind.clone()) {}
  SensorFigures(const SensorFigures& other) : kind_(other.kind_->clone()) {}
  SensorFigures(SensorFigures&&) noexcept = default;
  SensorFigures& operator=(SensorFigures other) noexcept { return kind_.swap(other.kind_), *this; }

  SensorKind& operator*() const { return *kind_; }
  SensorKind* operator->() const { return kind_.get(); }

 private:
  std::unique_ptr<SensorKind> kind_;
};

struct SensorItem {
  SensorItem(const SensorKind& kind, std::string its_name) : figures(kind), name(std::move(its_name)), rate_hz(kind.usual_rate_hz()) {}

  SensorFigures figures;
  std::string name;      // lower-case letters, digits and underscores
  Carrier ride{};        // what carries it instead of the rig
  Vec3 position;         // in the rig or the link (X forward, Y left, Z up); unit: m
  Vec3 rpy_deg;          // likewise; unit: degree
  double rate_hz;        // of its readings, unless its kind has a rate of its own; unit: Hz
  bool noise = true;     // false: exact
  std::optional<std::string> topic{};     // ROS; not given: see topic_of()
  std::optional<std::string> frame_id{};  // TF; not given: "NAME_link"

  std::string key() const { return figures->key() + "." + name; }  // of the mission
  double rate() const { return figures->own_rate_hz().value_or(rate_hz); }  // unit: Hz
  std::string frame() const { return frame_id.value_or(name + "_link"); }
  Pose carrier_from_sensor() const;
  // Of reading k.
  std::int64_t stamp_ns(std::int64_t k, std::int64_t start_ns) const;
  std::uint64_t noise_seed(std::uint64_t mission_seed) const;  // of the noise of all sensors
  // As SensorKind::start().
  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::uint64_t mission_seed) const;
};

// ROS: its own key; else that of its kind, if it is the only one of it, and with its name else.
std::string topic_of(const std::vector<SensorItem>& sensors, const SensorItem& sensor);
bool casts_rays(const std::vector<SensorItem>& sensors);  // any of them
bool scans(const SensorItem& sensor);  // whether its readings are scans

// A key for each kind: the sensors of that kind, by name.
void add_sensor_keys(Schema& keys, std::vector<SensorItem>& sensors);
// Of single sensors; what their names and carriers contradict is found with those of other sensors.
void check_sensors(const std::vector<SensorItem>& sensors, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
