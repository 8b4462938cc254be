// Sensors that give a few numbers, in runs of the program: recorded, verified, and of a kind that lies outside of the tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "app/pipeline/recorders.h"
#include "app/sensors/robot_readings.h"
#include "io/ros/ros_messages.h"
#include "scripting/mission.h"
#include "scripting/scenario/scenario.h"
#include "scripting/sensors/sensor_item.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace sensor_run_test {

// Rows of a table, without its head.
std::vector<std::vector<double>> read_table(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<double>& row = rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::strtod(cell.c_str(), nullptr));
  }
  return rows;
}

// Into a slab's shadow, against a wall: by the bundled mission.
TEST(SensorRun, TheWayUnderASlabIsInTheReadings) {
  const ScratchFolder scratch;
  const std::string out = scratch / "out";
  const Outcome run = run_rubble(std::string("run ") + RUBBLE_SOURCE_DIR + "/scripts/robots/readings.lua --out " + out +
                                 " --set camera.width=32 --set camera.height=24 --set trajectory.rate_hz=0.5");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("warning"), std::string::npos) << run.err;
  ASSERT_EQ(read_table(out + "/sensors/sonar.csv").size(), 101u);
  for (const auto& row : read_table(out + "/sensors/tof.csv")) EXPECT_TRUE(row[1] >= 0.04 || std::isinf(row[1])) << row[1];
  // Nothing is in the bumper's way, then the wall; it is pressed where the force says so.
  double before = 0, after = 0;
  for (const auto& row : read_table(out + "/sensors/bow.csv")) {
    double& most = row[0] < 8e9 ? before : after;
    most = std::max(most, row[2]);
    EXPECT_EQ(row[1], row[2] >= 20 ? 1 : 0);
  }
  EXPECT_EQ(before, 0);
  EXPECT_GE(after, 20);
  // The receiver has a fix in the open and none at the end; where it has one, its error is of some metres.
  const auto gps = read_table(out + "/sensors/gps.csv");
  EXPECT_GE(gps.front()[4], 4);
  EXPECT_NEAR((gps.front()[1] - 42.36) * 111074, 0, 20);
  EXPECT_LT(gps.back()[4], 4);
  EXPECT_TRUE(std::isnan(gps.back()[1]));
  // Height from pressure stays: the crawler drives on the level, but for its noise and drift.
  const auto baro = read_table(out + "/sensors/baro.csv");
  EXPECT_NEAR(baro.front()[1], 101325 * std::pow(1 - 0.0065 * 40 / 288.15, 5.255877), 120);

  const std::string said = scratch / "compared";
  const int code = std::system(("/usr/bin/python3 " RUBBLE_SOURCE_DIR "/tests/app/read_readings.py " + out + " >" + said + " 2>&1").c_str());
  EXPECT_EQ(code, 0) << read_file(said);
  EXPECT_GT(std::atoi(read_file(said).c_str()), 2000) << read_file(said);
  const Outcome verified = run_rubble("verify " + out);
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

// Zero: unknown, or none.
TEST(SensorRun, MessagesOfExactReadingsStateNoVariance) {
  int kinds = 0;
  for (const SensorKind* kind : sensor_kinds()) {
    if (kind->key() != "magnetometers" && kind->key() != "barometers" && kind->key() != "attitudes") continue;
    ++kinds;
    const auto exact = kind->clone();
    exact->exact = true;
    const Reading reading{0, 1, std::vector<double>(kind->columns().size(), 0.5), nullptr};
    const auto bytes = [&](const SensorKind& of) { return of.message(0, ros::Version::ros2, {0, 1, "a"}, reading); };
    const std::string was = bytes(*kind), is = bytes(*exact);
    ASSERT_EQ(was.size(), is.size());
    EXPECT_NE(was, is) << kind->key();
    for (std::size_t i = 0; i < is.size(); ++i)
      if (was[i] != is[i]) {
        EXPECT_EQ(is[i], 0) << kind->key() << " " << i;
      }
  }
  EXPECT_EQ(kinds, 3);
}

TEST(SensorRun, MistakesAreNamedByTheLine) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua",
             "return rubble.mission {\n  pile = { layers = 0 },\n  robots = { { name = 'r', model = 'rover' } },\n"
             "  bumpers = { b = { ride = { robot = 'r' }, links = { 'nose' } } },\n"
             "  gnss = { g = { ride = { robot = 'r' } } },\n}\n");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --out " + (scratch / "out"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("m.lua:4: bumpers.b.links[1]: the robot has no such link: expected one of base_link"), std::string::npos) << run.err;
}

TEST(SensorRun, ASensorInsideOfItsLinkIsAWarning) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua",
             "return rubble.mission {\n  pile = { layers = 0 },\n  robots = { { name = 'r', model = 'crawler', position = { 0, 0, 0.001 } } },\n"
             "  robot_run = { duration = 0.5 },\n  gnss = { g = { ride = { robot = 'r' }, position = { 0, 0, 0.2 } } },\n"
             "  camera = { width = 32, height = 24 }, trajectory = { rate_hz = 1 },\n}\n");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --out " + (scratch / "out"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("gnss.g: the sensor is inside of `base_link`"), std::string::npos) << run.err;
}

// A kind as another project would write it: one class, registered by one call.
class Thermometer : public SensorKind {
 public:
  std::string key() const override { return "thermometers"; }
  std::string title() const override { return "thermometer"; }
  std::string example() const override { return "outside"; }
  std::string doc() const override { return "Thermometers."; }
  double usual_rate_hz() const override { return 2; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<Thermometer>(*this); }
  void add_keys(Schema& keys) override { keys.value("at_ground", at_ground_, "At z = 0.").between(-100, 100).unit("degree"); }
  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t>, double) const override {
    class Meter : public SensorMeter {
     public:
      Meter(const SensorSite& s, double t) : site_(s), at_ground_(t) {}
      std::vector<double> read(double t) override { return {at_ground_ - 0.0065 * site_.world_from_sensor(t).translation.z}; }

     private:
      const SensorSite& site_;
      double at_ground_;
    };
    return std::make_unique<Meter>(site, at_ground_);
  }
  std::vector<ReadingColumn> columns() const override { return {{"temperature", "degree"}}; }
  std::vector<Topic> topics() const override { return {{"", &ros::kFluidPressure}}; }
  std::string message(std::size_t, ros::Version version, const ros::Header& header, const Reading& r) const override {
    return ros::fluid_pressure(version, header, r.values[0], 0);
  }

 private:
  double at_ground_ = 20;
};

TEST(SensorRun, AKindFromOutsideIsReadNamedAndRecorded) {
  register_sensor(std::make_unique<Thermometer>());
  EXPECT_THROW(register_sensor(std::make_unique<Thermometer>()), InputError);
  const Scenario s =
      load_mission_text("return rubble.mission { thermometers = { t = { at_ground = 30, position = { 0, 0, 2 } } } }", "m.lua").scenario;
  ASSERT_EQ(s.sensors.size(), 1u);
  EXPECT_NE(scenario_to_json(s).find("\"at_ground\": 30"), std::string::npos);
  const Recording recording = describe_recording(s, {}, {});
  ASSERT_EQ(recording.sensors.size(), 1u);
  EXPECT_EQ(recording.sensors[0].topic, "/t");
  SensorSite site;
  site.world_from_sensor = [](double) { return Pose{{}, {0, 0, 100}}; };
  EXPECT_DOUBLE_EQ(s.sensors[0].start(site, 1)->read(0).at(0), 30 - 0.65);
  EXPECT_THROW(load_mission_text("return rubble.mission { thermometers = { t = { at_ground = 300 } } }", "m.lua"), InputError);
}

}  // namespace sensor_run_test
}  // namespace rubble::testing
