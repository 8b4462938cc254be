// LiDARs: spinning, rosette and planar patterns of rays through the exact geometry, smoke and dust (render/lidar).
#include "scripting/sensors/lidar.h"

#include <algorithm>

#include "io/ros/ros_messages.h"
#include "kernel/base/number_text.h"
#include "render/lidar/lidar.h"

namespace rubble {
namespace {

class LidarMeter : public SensorMeter {
 public:
  LidarMeter(const SensorSite& site, const LidarSpec& spec)
      : lidar_(spec, site.rays, {place_of(site), site.start_ns}, *site.air, site.seed, site.threads) {}
  std::shared_ptr<const RangeScan> scan(int number) override { return std::make_shared<const RangeScan>(lidar_.take(number)); }

 private:
  static std::function<Pose(std::int64_t)> place_of(const SensorSite& site) {
    return [&site](std::int64_t stamp_ns) { return site.world_from_sensor(double(stamp_ns - site.start_ns) * 1e-9); };
  }

  Lidar lidar_;
};

bool one_of(int value, const std::vector<int>& allowed) {
  return std::find(allowed.begin(), allowed.end(), value) != allowed.end();
}

// Mistakes of one LiDAR, in the order in which they are found.
class Mistakes {
 public:
  explicit Mistakes(const LidarFigures& figures) : f_(figures) {
    check_count("channels", f_.channels, {32, 64, 128});
    check_count("columns", f_.columns, {512, 1024, 2048});
    if (f_.has_own_beams()) check_beams();
    if (f_.planar() && f_.driver != LidarDriver::velodyne)
      add("driver", "a 2-D scanner has LaserScan alone", "no such key", f_.driver == LidarDriver::ouster ? "ouster" : "livox");
    const LidarSpec spec = f_.spec();
    if (spec.min_range >= spec.max_range)
      add("max_range", "the range is empty", "more than min_range, " + exact_text(spec.min_range) + " m",
          exact_text(spec.max_range) + " m");
  }
  std::vector<Diagnostic> take() { return std::move(found_); }

 private:
  void add(const std::string& key, const std::string& message, const std::string& expected, const std::string& found) {
    found_.push_back({"", 0, key, message, expected, found, ""});
  }

  void check_count(const char* key, int value, const std::vector<int>& allowed) {
    std::string list;
    for (const int v : allowed) list += (list.empty() ? "" : ", ") + std::to_string(v);
    if (!f_.has_channels() && value != 0)
      add(key, "this model has a fixed number", "no such key", std::to_string(value));
    else if (value != 0 && !one_of(value, allowed))
      add(key, "the model has no such version", list, std::to_string(value));
  }

  void check_beams() {
    const std::vector<double>& elevations = f_.beam_elevations_deg;
    const std::size_t rings = !elevations.empty() ? elevations.size() : f_.channels > 0 ? std::size_t(f_.channels) : 64;
    if (!f_.has_channels()) {
      add(!elevations.empty() ? "beam_elevations_deg" : !f_.beam_azimuths_deg.empty() ? "beam_azimuths_deg" : f_.beam_radius != 0 ? "beam_radius" : "beam_height",
          "only the beams of os0, os1 and os2 can be set", "no such key", "a value");
      return;
    }
    if (!std::is_sorted(elevations.begin(), elevations.end()))
      add("beam_elevations_deg", "the rings are not in order", "elevations from the lowest to the highest", "another order");
    if (elevations.size() > 128) add("beam_elevations_deg", "too many rings", "at most 128", std::to_string(elevations.size()));
    if (f_.channels > 0 && std::size_t(f_.channels) != rings)
      add("channels", "not the number of `beam_elevations_deg`", std::to_string(rings), std::to_string(f_.channels));
    if (!f_.beam_azimuths_deg.empty() && f_.beam_azimuths_deg.size() != rings)
      add("beam_azimuths_deg", "not one for each ring", std::to_string(rings), std::to_string(f_.beam_azimuths_deg.size()));
  }

  const LidarFigures& f_;
  std::vector<Diagnostic> found_;
};

class LidarKind : public SensorKind {
 public:
  LidarKind() = default;
  explicit LidarKind(const LidarFigures& figures) : f_(figures) {}

  std::string key() const override { return "lidars"; }
  std::string title() const override { return "LiDAR"; }
  std::string example() const override { return "top"; }
  std::string doc() const override {
    return "LiDARs (docs/reference/lidar.md). Names have lower-case letters, digits and underscores. A LiDAR is fixed to the rig, "
           "which flies the trajectory, or to a link of a robot (`ride`). It takes whole scans from the start to the last camera "
           "frame, at least one, and sees the same smoke and dust. `noise = false` leaves `range_step`. Topics: `/points`, or "
           "`/scan` of a 2-D scanner; with several of a kind `/NAME/points`, `/NAME/scan`.";
  }
  double usual_rate_hz() const override { return 10; }
  std::optional<double> own_rate_hz() const override { return f_.rate(); }
  bool casts_rays() const override { return true; }
  SensorTiming timing(double) const override { return {true, 0, Lidar::kSceneStep}; }
  std::string summary(double rate_hz) const override { return f_.spec().model + ", " + exact_text(rate_hz) + " scans/s"; }
  std::string usual_topic() const override { return f_.planar() ? "/scan" : "/points"; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<LidarKind>(*this); }

  void add_model_key(Schema& k) override {
    k.choice("model", f_.model, lidar_model_names(),
             "The model. It sets the defaults of the other keys (docs/reference/lidar.md).");
  }
  void add_keys(Schema& k) override {
    k.value("channels", f_.channels, "`os0`, `os1`, `os2`: number of rings, 32, 64 or 128; 0: 64.").between(0, 128);
    k.value("columns", f_.columns, "`os0`, `os1`, `os2`: firings of each ring in a scan, 512, 1024 or 2048; 0: 1024.").between(0, 2048);
    add_beams(k);
    add_ranges(k);
    k.choice("returns", f_.returns, {"strongest", "last", "dual"},
             "Reported echoes of a ray. `dual`: the strongest and the last; if these are the same, the two strongest.");
    k.choice("driver", f_.driver, {"velodyne", "ouster", "livox"},
             "Whose driver's ROS messages the scans are (docs/reference/lidar.md); not of 2-D scanners. `velodyne`: `ring`, `time`. "
             "`ouster`: `t`, `ring`, `range` and others. `livox`: `livox_ros_driver2/CustomMsg`.");
  }
  std::vector<Diagnostic> find_mistakes() const override { return Mistakes(f_).take(); }

  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t> noise, double) const override {
    LidarSpec spec = f_.spec();
    spec.noise = noise.has_value();
    return std::make_unique<LidarMeter>(site, spec);
  }

  std::vector<ReadingColumn> columns() const override { return {}; }
  double most_points() const override {
    const LidarSpec spec = f_.spec();
    return spec.rays() * (spec.returns == LidarReturns::dual ? 2.0 : 1.0);
  }
  std::shared_ptr<const LidarSpec> scan_spec() const override { return std::make_shared<const LidarSpec>(f_.spec()); }
  std::string sample_name() const override { return "lidar"; }
  std::vector<Topic> topics() const override {
    return {{"", f_.planar() ? &ros::kLaserScan : f_.driver == LidarDriver::livox ? &ros::kLivoxScan : &ros::kPointCloud}};
  }
  std::string message(std::size_t, ros::Version version, const ros::Header& header, const Reading& reading) const override {
    if (f_.planar()) return ros::laser_scan(version, header, *reading.scan);
    const std::vector<ScanPoint>& points = reading.scan->points;
    if (f_.driver == LidarDriver::ouster) return ros::ouster_cloud(version, header, points);
    return f_.driver == LidarDriver::livox ? ros::livox_scan(version, header, points) : ros::point_cloud(version, header, points);
  }
  RawlogObservation observe(const Reading& reading) const override { return ScanObservation{reading.scan}; }

 private:
  // Of one unit, as its calibration has them.
  void add_beams(Schema& k) {
    k.value("beam_elevations_deg", f_.beam_elevations_deg,
            "`os0`, `os1`, `os2`: elevation of each ring, from the lowest, at most 128 rings. `rubble.read_calibration` reads "
            "it and the next three from a sensor's own metadata.")
        .between(-90, 90)
        .unit("degree");
    k.value("beam_azimuths_deg", f_.beam_azimuths_deg,
            "Azimuth of each ring beside the direction of its column; positive: to the left. Empty: 0.")
        .between(-180, 180)
        .unit("degree");
    k.value("beam_radius", f_.beam_radius, "Distance of the point that rays leave from the axis of rotation.").between(0, 1).unit("m");
    k.value("beam_height", f_.beam_height, "Height of this point above the origin of the sensor.").between(-1, 1).unit("m");
  }

  void add_ranges(Schema& k) {
    k.value("rate_hz", f_.rate_hz, "Scans per second. Not given: the value of the model, as for all keys down to `divergence_mrad`.")
        .between(1, 100)
        .unit("Hz");
    k.value("min_range", f_.min_range, "Shorter distances give no echo.").between(0.01, 100).unit("m");
    k.value("max_range", f_.max_range, "Longer distances give no echo.").between(0.1, 1000).unit("m");
    k.value("range_at_10_percent", f_.range_at_10_percent,
            "Range in clear air for a surface of 10 % reflectance at normal incidence.")
        .between(0.1, 1000)
        .unit("m");
    k.value("range_noise", f_.range_noise, "Standard deviation of the range.").between(0, 1).unit("m");
    k.value("range_step", f_.range_step, "Resolution of the range; 0: not rounded.").between(0, 1).unit("m");
    k.value("divergence_mrad", f_.divergence_mrad,
            "Full angle of the beam at 1/e^2 of its central intensity; 0: a line, without echoes of two surfaces.")
        .between(0, 100)
        .unit("mrad");
  }

  LidarFigures f_;
};

}  // namespace

std::unique_ptr<SensorKind> make_lidar() { return std::make_unique<LidarKind>(); }

SensorItem make_lidar_item(const std::string& name, const LidarFigures& figures) { return {LidarKind(figures), name}; }

}  // namespace rubble
