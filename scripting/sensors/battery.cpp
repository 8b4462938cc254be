// A battery: what the motors of a robot and its electronics draw from a pack of lithium-ion cells.
//
// The open-circuit voltage falls linearly with the charge, as in Gazebo's linear battery; an inner resistance takes its part
// of it. A motor draws the mechanical power that it gives, divided by its efficiency. Braking gives nothing back, and to
// hold a load costs nothing. An empty battery stops nothing.
//
// Defaults: 7 cells in series of 4.2 to 3.3 V, 10 A h, 15 mOhm a cell, as packs of small ground robots have; the efficiency
// is that of geared DC motors, 0.5 to 0.8; all are our choice.
#include <algorithm>
#include <cmath>

#include "io/ros/ros_messages.h"
#include "scripting/sensors/sensor_kind.h"

namespace rubble {
namespace {

constexpr double kFullCell = 4.2, kEmptyCell = 3.3;  // unit: V

struct BatteryFigures {
  int cells = 7;
  double capacity_ah = 10, charge = 1, resistance = 0.1, idle_power = 20, efficiency = 0.6;
};

class BatteryMeter : public SensorMeter {
 public:
  BatteryMeter(const SensorSite& site, const BatteryFigures& f) : site_(site), f_(f), charge_(f.charge) {}

  // The mean current since the reading before.
  std::vector<double> read(double t) override {
    const double span = t - last_, motors = span > 0 ? site_.motor_work(last_, t) / span : 0;
    const double open = double(f_.cells) * (kEmptyCell + (kFullCell - kEmptyCell) * charge_);
    const double power = f_.idle_power + motors / f_.efficiency;
    // power = current (open - current resistance): the smaller current; of more than it can give, the most that it gives.
    const double root = std::sqrt(std::max(open * open - 4 * f_.resistance * power, 0.0));
    const double current = charge_ > 0 ? (open - root) / (2 * f_.resistance) : 0;
    charge_ = std::max(charge_ - current * span / (3600 * f_.capacity_ah), 0.0);
    last_ = t;
    return {open - current * f_.resistance, current, charge_};
  }

 private:
  const SensorSite& site_;
  BatteryFigures f_;
  double charge_, last_ = 0;
};

class Battery : public SensorKind {
 public:
  std::string key() const override { return "batteries"; }
  std::string title() const override { return "battery"; }
  std::string example() const override { return "battery"; }
  std::string doc() const override {
    return "Batteries of robots: the charge that motors and electronics leave. A motor draws its mechanical power by its "
           "efficiency; braking gives nothing back, holding a load costs nothing, and an empty battery stops nothing.";
  }
  double usual_rate_hz() const override { return 1; }
  std::string usual_topic() const override { return "/battery_state"; }
  bool on_robots_only() const override { return true; }
  bool feels_motors() const override { return true; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<Battery>(*this); }

  void add_keys(Schema& k) override {
    k.value("cells", f_.cells, "Lithium-ion cells in series, each of 4.2 V when full and 3.3 V when empty.").between(1, 200);
    k.value("capacity_ah", f_.capacity_ah, "Charge when full.").above(0, 1e5).unit("A h");
    k.value("charge", f_.charge, "Share of the capacity at the start.").between(0, 1);
    k.value("resistance", f_.resistance, "Inner resistance of the pack.").above(0, 100).unit("ohm");
    k.value("idle_power", f_.idle_power, "What electronics draw all the time.").between(0, 1e5).unit("W");
    k.value("efficiency", f_.efficiency, "Of motors with their gears.").above(0, 1);
  }
  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t>, double) const override {
    return std::make_unique<BatteryMeter>(site, f_);
  }

  std::vector<ReadingColumn> columns() const override { return {{"voltage", "V"}, {"current", "A"}, {"charge", ""}}; }
  std::vector<Topic> topics() const override { return {{"", &ros::kBatteryState}}; }
  std::string message(std::size_t, ros::Version version, const ros::Header& header, const Reading& reading) const override {
    return ros::battery_state(version, header,
                              {reading.values[0], reading.values[1], reading.values[2], f_.capacity_ah, std::size_t(f_.cells)});
  }

 private:
  BatteryFigures f_;
};

}  // namespace

std::unique_ptr<SensorKind> make_battery() { return std::make_unique<Battery>(); }

}  // namespace rubble
