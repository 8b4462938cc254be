// An attitude and heading reference: the orientation in the world, as a filter in the sensor would estimate it.
//
// The error is a small rotation about the world's axes: tilt about X and Y, heading about Z; each drifts as a first-order
// Gauss-Markov process and has white noise. Defaults: Xsens MTi-3 (data sheet: roll and pitch 0.5 degrees, yaw 2 degrees
// RMS); the correlation time is our choice.
#include "io/ros/ros_messages.h"
#include "kernel/base/portable_math.h"
#include "scripting/sensors/sensor_error.h"
#include "scripting/sensors/sensor_kind.h"

namespace rubble {
namespace {

constexpr double kRad = portable::kPi / 180;

struct AttitudeFigures {
  double tilt_drift_deg = 0.5, heading_drift_deg = 2, drift_time = 60, noise_deg = 0.05;
};

class AttitudeMeter : public SensorMeter {
 public:
  AttitudeMeter(const SensorSite& site, const AttitudeFigures& f, std::optional<std::uint64_t> seed, double rate_hz)
      : site_(site), x_(of(f.tilt_drift_deg, f), seed, "x", rate_hz), y_(of(f.tilt_drift_deg, f), seed, "y", rate_hz),
        z_(of(f.heading_drift_deg, f), seed, "z", rate_hz) {}

  std::vector<double> read(double t) override {
    const double x = x_.next(), y = y_.next(), z = z_.next();
    const Quat q = normalized(portable::quat_from_rpy(x, y, z) * site_.world_from_sensor(t).rotation);
    return {q.x, q.y, q.z, q.w};
  }

 private:
  static ErrorFigures of(double drift_deg, const AttitudeFigures& f) {
    ErrorFigures figures;
    figures.noise = f.noise_deg * kRad, figures.drift = drift_deg * kRad, figures.drift_time = f.drift_time;
    return figures;
  }
  const SensorSite& site_;
  SensorError x_, y_, z_;
};

class Attitude : public SensorKind {
 public:
  std::string key() const override { return "attitudes"; }
  std::string title() const override { return "attitude sensor"; }
  std::string example() const override { return "ahrs"; }
  std::string doc() const override { return "Attitude and heading references (AHRS): the orientation of the sensor in the world, with drift."; }
  double usual_rate_hz() const override { return 100; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<Attitude>(*this); }

  void add_keys(Schema& k) override {
    k.value("tilt_drift_deg", f_.tilt_drift_deg, "Standard deviation of the slow error about the world's X and Y.").between(0, 90).unit("degree");
    k.value("heading_drift_deg", f_.heading_drift_deg, "Standard deviation of the slow error about Z.").between(0, 180).unit("degree");
    k.value("drift_time", f_.drift_time, "Correlation time of the slow errors.").above(0, 1e6).unit("s");
    k.value("noise_deg", f_.noise_deg, "Standard deviation of white noise about each axis.").between(0, 90).unit("degree");
  }
  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t> seed, double rate_hz) const override {
    return std::make_unique<AttitudeMeter>(site, f_, seed, rate_hz);
  }

  std::vector<ReadingColumn> columns() const override { return {{"qx", ""}, {"qy", ""}, {"qz", ""}, {"qw", ""}}; }
  std::vector<Topic> topics() const override { return {{"", &ros::kImu}}; }
  std::string message(std::size_t, ros::Version version, const ros::Header& header, const Reading& r) const override {
    const auto variance = [this](double drift) { return exact ? 0 : (drift * drift + f_.noise_deg * f_.noise_deg) * kRad * kRad; };
    const double tilt = variance(f_.tilt_drift_deg);
    return ros::attitude(version, header, {r.values[3], r.values[0], r.values[1], r.values[2]},
                         {tilt, tilt, variance(f_.heading_drift_deg)});
  }
  RawlogObservation observe(const Reading& reading) const override {
    InertialObservation inertial;
    inertial.orientation = reading.values;
    return inertial;
  }

 private:
  AttitudeFigures f_;
};

}  // namespace

std::unique_ptr<SensorKind> make_attitude() { return std::make_unique<Attitude>(); }

}  // namespace rubble
