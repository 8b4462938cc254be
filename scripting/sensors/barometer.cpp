// A barometer: the pressure of the International Standard Atmosphere (ISO 2533) at its height, with noise and drift.
//
// Defaults: Bosch BMP388 (data sheet: absolute accuracy +-50 Pa, of which a bias of a third is drawn; it tells heights 10 cm
// apart, which is 1.2 Pa). The drift stands for weather and draughts: 10 Pa with a correlation of ten minutes, our choice.
#include <cmath>

#include "io/ros/ros_messages.h"
#include "kernel/base/portable_math.h"
#include "scripting/sensors/sensor_error.h"
#include "scripting/sensors/sensor_kind.h"

namespace rubble {
namespace {

struct BarometerFigures {
  double sea_level_pressure = 101325, altitude = 0;
  double pressure_noise = 1.2, pressure_bias = 17, pressure_drift = 10, drift_time = 600;
};

// p0 (1 - L h / T0)^(g M / (R L))
double pressure_at(double altitude, double at_sea_level) {
  constexpr double kLapse = 0.0065, kTemperature = 288.15, kExponent = 5.255877;  // unit: K/m, K, 1
  return at_sea_level * portable::exp(kExponent * portable::log(1 - kLapse * altitude / kTemperature));
}

class BarometerMeter : public SensorMeter {
 public:
  BarometerMeter(const SensorSite& site, const BarometerFigures& f, std::optional<std::uint64_t> seed, double rate_hz)
      : site_(site), f_(f), error_({f.pressure_noise, f.pressure_bias, 0, f.pressure_drift, f.drift_time}, seed, "pressure", rate_hz) {}
  std::vector<double> read(double t) override {
    return {pressure_at(f_.altitude + site_.world_from_sensor(t).translation.z, f_.sea_level_pressure) + error_.next()};
  }

 private:
  const SensorSite& site_;
  BarometerFigures f_;
  SensorError error_;
};

class Barometer : public SensorKind {
 public:
  std::string key() const override { return "barometers"; }
  std::string title() const override { return "barometer"; }
  std::string example() const override { return "baro"; }
  std::string doc() const override { return "Barometers: the air pressure at the sensor's height in the standard atmosphere."; }
  double usual_rate_hz() const override { return 25; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<Barometer>(*this); }

  void add_keys(Schema& k) override {
    k.value("sea_level_pressure", f_.sea_level_pressure, "Pressure at sea level.").between(80000, 110000).unit("Pa");
    k.value("altitude", f_.altitude, "Of the ground z = 0 above the sea.").between(-500, 9000).unit("m");
    k.value("pressure_noise", f_.pressure_noise, "Standard deviation of white noise.").between(0, 1000).unit("Pa");
    k.value("pressure_bias", f_.pressure_bias, "Standard deviation of the error that stays, drawn once.").between(0, 1e4).unit("Pa");
    k.value("pressure_drift", f_.pressure_drift, "Standard deviation of the slow error.").between(0, 1e4).unit("Pa");
    k.value("drift_time", f_.drift_time, "Correlation time of the slow error.").above(0, 1e6).unit("s");
  }
  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t> seed, double rate_hz) const override {
    return std::make_unique<BarometerMeter>(site, f_, seed, rate_hz);
  }

  std::vector<ReadingColumn> columns() const override { return {{"pressure", "Pa"}}; }
  std::vector<Topic> topics() const override { return {{"", &ros::kFluidPressure}}; }
  std::string message(std::size_t, ros::Version version, const ros::Header& header, const Reading& reading) const override {
    return ros::fluid_pressure(version, header, reading.values[0], exact ? 0 : f_.pressure_noise * f_.pressure_noise);
  }
  RawlogObservation observe(const Reading& reading) const override {
    InertialObservation inertial;
    inertial.pressure = reading.values;
    return inertial;
  }

 private:
  BarometerFigures f_;
};

}  // namespace

std::unique_ptr<SensorKind> make_barometer() { return std::make_unique<Barometer>(); }

}  // namespace rubble
