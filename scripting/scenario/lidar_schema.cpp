#include "scripting/scenario/lidar_schema.h"

#include <algorithm>

#include "scripting/scenario/robot_scenario.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

void add_figures(Schema& k, LidarScenario& l) {
  k.value("rate_hz", l.rate_hz,
          "Scans per second. Not given: the value of the model, as for all keys down to `divergence_mrad`.")
      .between(1, 100)
      .unit("Hz");
  k.value("min_range", l.min_range, "Shorter distances give no echo.").between(0.01, 100).unit("m");
  k.value("max_range", l.max_range, "Longer distances give no echo.").between(0.1, 1000).unit("m");
  k.value("range_at_10_percent", l.range_at_10_percent,
          "Range in clear air for a surface of 10 % reflectance at normal incidence.")
      .between(0.1, 1000)
      .unit("m");
  k.value("range_noise", l.range_noise, "Standard deviation of the range.").between(0, 1).unit("m");
  k.value("range_step", l.range_step, "Resolution of the range; 0: not rounded.").between(0, 1).unit("m");
  k.value("divergence_mrad", l.divergence_mrad,
          "Full angle of the beam at 1/e^2 of its central intensity; 0: a line, without echoes of two surfaces.")
      .between(0, 100)
      .unit("mrad");
}

// Of one unit, as its calibration has them.
void add_beams(Schema& k, LidarScenario& l) {
  k.value("beam_elevations_deg", l.beam_elevations_deg,
          "`os0`, `os1`, `os2`: elevation of each ring, from the lowest, at most 128 rings. `rubble.read_calibration` reads "
          "it and the next three from a sensor's own metadata.")
      .between(-90, 90)
      .unit("degree");
  k.value("beam_azimuths_deg", l.beam_azimuths_deg,
          "Azimuth of each ring beside the direction of its column; positive: to the left. Empty: 0.")
      .between(-180, 180)
      .unit("degree");
  k.value("beam_radius", l.beam_radius, "Distance of the point that rays leave from the axis of rotation.").between(0, 1).unit("m");
  k.value("beam_height", l.beam_height, "Height of this point above the origin of the sensor.").between(-1, 1).unit("m");
}

Schema lidar_schema(LidarScenario& l) {
  Schema k;
  k.choice("model", l.model, {"vlp16", "os0", "os1", "os2", "mid360", "utm30lx"},
           "The model. It sets the defaults of the other keys (docs/reference/lidar.md).");
  add_ride_keys(k, "", l.ride);
  k.value("position", l.position, "Position on the rig, or on the link of `ride`: X forward, Y left, Z up.").between(-10, 10).unit("m");
  k.value("rpy_deg", l.rpy_deg, "Orientation in the same frame: roll, pitch (positive: down), yaw.")
      .between(-360, 360)
      .unit("degree");
  k.value("channels", l.channels, "`os0`, `os1`, `os2`: number of rings, 32, 64 or 128; 0: 64.").between(0, 128);
  k.value("columns", l.columns,
          "`os0`, `os1`, `os2`: firings of each ring in a scan, 512, 1024 or 2048; 0: 1024.")
      .between(0, 2048);
  add_beams(k, l);
  add_figures(k, l);
  k.choice("returns", l.returns, {"strongest", "last", "dual"},
           "Reported echoes of a ray. `dual`: the strongest and the last; if these are the same, the two strongest.");
  k.value("noise", l.noise, "false: exact ranges, except for `range_step`, and no random detection.");
  k.value("topic", l.topic,
          "ROS topic; not given: `/points`, or `/scan` of a 2-D scanner; with several of a kind `/NAME/points`, "
          "`/NAME/scan`.");
  k.value("frame_id", l.frame_id, "TF frame; not given: `NAME_link`.");
  return k;
}

bool one_of(int value, const std::vector<int>& allowed) {
  return std::find(allowed.begin(), allowed.end(), value) != allowed.end();
}

void check_beams(const LidarScenario& lidar, std::vector<Diagnostic>& mistakes) {
  const std::string at = "lidars." + lidar.name + ".";
  const auto add = [&](const std::string& key, const std::string& message, const std::string& expected,
                       const std::string& found) {
    mistakes.push_back({"", 0, at + key, message, expected, found, ""});
  };
  if (!lidar.has_own_beams()) return;
  const std::vector<double>& elevations = lidar.beam_elevations_deg;
  const std::size_t rings = !elevations.empty() ? elevations.size() : lidar.channels > 0 ? std::size_t(lidar.channels) : 64;
  if (!lidar.has_channels()) {
    add(!elevations.empty() ? "beam_elevations_deg" : !lidar.beam_azimuths_deg.empty() ? "beam_azimuths_deg" : lidar.beam_radius != 0 ? "beam_radius" : "beam_height",
        "only the beams of os0, os1 and os2 can be set", "no such key", "a value");
    return;
  }
  if (!std::is_sorted(elevations.begin(), elevations.end()))
    add("beam_elevations_deg", "the rings are not in order", "elevations from the lowest to the highest", "another order");
  if (elevations.size() > 128) add("beam_elevations_deg", "too many rings", "at most 128", std::to_string(elevations.size()));
  if (lidar.channels > 0 && std::size_t(lidar.channels) != rings)
    add("channels", "not the number of `beam_elevations_deg`", std::to_string(rings), std::to_string(lidar.channels));
  if (!lidar.beam_azimuths_deg.empty() && lidar.beam_azimuths_deg.size() != rings)
    add("beam_azimuths_deg", "not one for each ring", std::to_string(rings), std::to_string(lidar.beam_azimuths_deg.size()));
}

void check_lidar(const LidarScenario& lidar, std::vector<Diagnostic>& mistakes) {
  const std::string at = "lidars." + lidar.name + ".";
  const auto add = [&](const std::string& key, const std::string& message, const std::string& expected,
                       const std::string& found) {
    mistakes.push_back({"", 0, at + key, message, expected, found, ""});
  };
  const auto check_count = [&](const char* key, int value, const std::vector<int>& allowed) {
    std::string list;
    for (const int v : allowed) list += (list.empty() ? "" : ", ") + std::to_string(v);
    if (!lidar.has_channels() && value != 0)
      add(key, "this model has a fixed number", "no such key", std::to_string(value));
    else if (value != 0 && !one_of(value, allowed))
      add(key, "the model has no such version", list, std::to_string(value));
  };
  check_count("channels", lidar.channels, {32, 64, 128});
  check_count("columns", lidar.columns, {512, 1024, 2048});
  check_beams(lidar, mistakes);
  const LidarSpec spec = lidar.spec();
  if (spec.min_range >= spec.max_range)
    add("max_range", "the range is empty", "more than min_range, " + format_number(spec.min_range) + " m",
        format_number(spec.max_range) + " m");
}

}  // namespace

void add_lidar_keys(Schema& keys, Scenario& s) {
  keys.add("lidars",
           "LiDARs: `lidars = { top = { model = \"vlp16\" } }`. Names have lower-case letters, digits and "
           "underscores. A LiDAR is fixed to the rig, which flies the trajectory, or to a link of a robot (`ride`). "
           "It takes whole scans from the start to the last camera frame, at least one, and sees the same smoke and dust.",
           [&s](std::size_t) {
             return Schema::named_tables(s.lidars, &LidarScenario::name, "top", lidar_schema);
           });
}

void check_lidars(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  for (const LidarScenario& lidar : scenario.lidars) check_lidar(lidar, mistakes);
  const OutputScenario& outputs = scenario.outputs;
  for (const auto& [key, wanted] : {std::pair{"outputs.pcd", outputs.pcd}, {"outputs.kitti", outputs.kitti}})
    if (wanted && scenario.lidars.empty())
      mistakes.push_back({"", 0, key, "there is nothing to write", "a mission with `lidars`", "none", ""});
}

std::string lidar_topic(const Scenario& scenario, std::size_t lidar) {
  const LidarScenario& its = scenario.lidars[lidar];
  if (its.topic) return *its.topic;
  const auto kin = std::count_if(scenario.lidars.begin(), scenario.lidars.end(), [&](const LidarScenario& other) {
    return other.planar() == its.planar() && !other.topic;
  });
  return (kin == 1 ? "" : "/" + its.name) + (its.planar() ? "/scan" : "/points");
}

}  // namespace rubble
