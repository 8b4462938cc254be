// A magnetometer: the Earth's field in the sensor's frame. Steel nearby bends the field of real ruins; here it does not.
//
// Defaults: the field near Boston, about 51 uT at 66 degrees down and 14 degrees west of north; noise of ST LIS3MDL (data
// sheet: 3.2 mgauss RMS); the bias is what remains of hard iron after a calibration, our choice.
#include "io/ros/ros_messages.h"
#include "kernel/base/portable_math.h"
#include "scripting/sensors/sensor_error.h"
#include "scripting/sensors/sensor_kind.h"

namespace rubble {
namespace {

constexpr double kMicro = 1e-6, kOneDegree = portable::kPi / 180;

struct MagnetometerFigures {
  double field_ut = 51, inclination_deg = 66, declination_deg = -14;
  double noise_ut = 0.32, bias_ut = 0.5, walk_ut = 0.01;
};

class MagnetometerMeter : public SensorMeter {
 public:
  MagnetometerMeter(const SensorSite& site, const MagnetometerFigures& f, std::optional<std::uint64_t> seed, double rate_hz)
      : site_(site), errors_{error(f, seed, "x", rate_hz), error(f, seed, "y", rate_hz), error(f, seed, "z", rate_hz)} {
    // Towards magnetic north: declination counts from north to east, which is clockwise from above.
    const auto [s, c] = portable::sincos((site.north_deg - f.declination_deg) * kOneDegree);
    const auto [down, level] = portable::sincos(f.inclination_deg * kOneDegree);
    field_ = Vec3{level * c, level * s, -down} * (f.field_ut * kMicro);
  }

  std::vector<double> read(double t) override {
    const Vec3 felt = site_.world_from_sensor(t).rotation.conjugate().rotate(field_);
    std::vector<double> values;
    for (int i = 0; i < 3; ++i) values.push_back(felt[i] + errors_[i].next());
    return values;
  }

 private:
  static SensorError error(const MagnetometerFigures& f, std::optional<std::uint64_t> seed, const char* axis, double rate_hz) {
    return SensorError({f.noise_ut * kMicro, f.bias_ut * kMicro, f.walk_ut * kMicro, 0, 1}, seed, axis, rate_hz);
  }
  const SensorSite& site_;
  Vec3 field_;  // in the world; unit: T
  SensorError errors_[3];
};

class Magnetometer : public SensorKind {
 public:
  std::string key() const override { return "magnetometers"; }
  std::string title() const override { return "magnetometer"; }
  std::string example() const override { return "mag"; }
  std::string doc() const override {
    return "Magnetometers: the Earth's field in the sensor's axes, undisturbed by steel. North is `light.north_deg`.";
  }
  double usual_rate_hz() const override { return 50; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<Magnetometer>(*this); }

  void add_keys(Schema& k) override {
    k.value("field_ut", f_.field_ut, "Strength of the field.").between(0, 100).unit("uT");
    k.value("inclination_deg", f_.inclination_deg, "Angle of the field below the horizon.").between(-90, 90).unit("degree");
    k.value("declination_deg", f_.declination_deg, "Angle of magnetic north east of north.").between(-180, 180).unit("degree");
    k.value("noise_ut", f_.noise_ut, "Standard deviation of white noise on each axis.").between(0, 100).unit("uT");
    k.value("bias_ut", f_.bias_ut, "Standard deviation of the bias of each axis, drawn once.").between(0, 100).unit("uT");
    k.value("walk_ut", f_.walk_ut, "Random walk of the biases.").between(0, 100).unit("uT/sqrt(s)");
  }
  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t> seed, double rate_hz) const override {
    return std::make_unique<MagnetometerMeter>(site, f_, seed, rate_hz);
  }

  std::vector<ReadingColumn> columns() const override { return {{"x", "T"}, {"y", "T"}, {"z", "T"}}; }
  std::vector<Topic> topics() const override { return {{"", &ros::kMagneticField}}; }
  std::string message(std::size_t, ros::Version version, const ros::Header& header, const Reading& r) const override {
    const double noise = exact ? 0 : f_.noise_ut * kMicro;
    return ros::magnetic_field(version, header, {r.values[0], r.values[1], r.values[2]}, noise * noise);
  }
  RawlogObservation observe(const Reading& reading) const override {
    InertialObservation inertial;
    inertial.magnetic_field = reading.values;
    return inertial;
  }

 private:
  MagnetometerFigures f_;
};

}  // namespace

std::unique_ptr<SensorKind> make_magnetometer() { return std::make_unique<Magnetometer>(); }

}  // namespace rubble
