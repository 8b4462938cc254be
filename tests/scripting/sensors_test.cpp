// Sensors that give a few numbers, against closed forms and published figures.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "io/ros/ros_messages.h"
#include "kernel/base/portable_math.h"
#include "render/lidar/lidar.h"
#include "scripting/mission.h"
#include "scripting/sensors/gps_constellation.h"
#include "scripting/sensors/sensor_error.h"
#include "scripting/sensors/sensor_item.h"

namespace rubble {
namespace sensors_test {

constexpr double kDegree = portable::kPi / 180;

const SensorKind& kind_of(const std::string& key) {
  for (const SensorKind* kind : sensor_kinds())
    if (kind->key() == key) return *kind;
  throw std::logic_error("no kind " + key);
}

// With figures as a mission sets them.
SensorItem make_sensor(const std::string& key, const std::vector<std::string>& settings = {}) {
  std::vector<SensorItem> sensors{SensorItem(kind_of(key), "it")};
  Schema schema;
  add_sensor_keys(schema, sensors);
  std::vector<Diagnostic> mistakes;
  for (const std::string& setting : settings) apply_override(schema, key + ".it." + setting, mistakes);
  EXPECT_TRUE(mistakes.empty()) << mistakes.front().text();
  return sensors.front();
}

// At rest at a place; what rays meet is a plane with that normal through a point, and nothing else.
SensorSite site_at(const Pose& place, const Vec3& point = {}, const Vec3& normal = {}) {
  SensorSite site;
  site.world_from_sensor = [place](double) { return place; };
  site.cast = [place, point, normal](double, const std::vector<Vec3>& directions, double range) {
    std::vector<SensorSite::Hit> hits(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const double along = dot(directions[i], normal), t = dot(point - place.translation, normal) / along;
      if (along != 0 && t > 0 && t <= range) hits[i] = {t, std::fabs(along), 0.5};
    }
    return hits;
  };
  return site;
}

double range_to(const Vec3& point, const Vec3& normal, std::vector<std::string> settings) {
  settings.insert(settings.end(), {"noise=false", "range_step=0"});
  const SensorSite site = site_at({}, point, normal);
  return make_sensor("range_finders", settings).start(site, 1)->read(0).at(0);
}

TEST(Sensors, AnInfraredBeamMeasuresTheWeightedMeanOfAFacingWall) {
  // Weights cos^3 over the solid angle of the cone; distances d / cos.
  const double k = portable::cos(13.5 * kDegree), d = 2;
  const double mean = d * ((1 - k * k * k) / 3) / ((1 - k * k * k * k) / 4);
  EXPECT_NEAR(range_to({d, 0, 0}, {-1, 0, 0}, {}), mean, 1e-3 * d);
  EXPECT_GT(mean, d * 1.005);
}

TEST(Sensors, AnUltrasonicBeamMeasuresTheNearestOfItsCone) {
  EXPECT_DOUBLE_EQ(range_to({2, 0, 0}, {-1, 0, 0}, {"radiation=ultrasound"}), 2);
  // A wall turned by 10 degrees: its foot of the perpendicular lies within the cone of +-13.5 degrees.
  const Vec3 turned{-portable::cos(10 * kDegree), portable::sin(10 * kDegree), 0};
  EXPECT_NEAR(range_to({2, 0, 0}, turned, {"radiation=ultrasound"}), 2 * portable::cos(10 * kDegree), 2e-3);
  // By 40 degrees: the nearest is at the edge of the cone.
  const Vec3 steep{-portable::cos(40 * kDegree), portable::sin(40 * kDegree), 0};
  const double edge = 2 * portable::cos(40 * kDegree) / portable::cos((40 - 13.5) * kDegree);
  EXPECT_NEAR(range_to({2, 0, 0}, steep, {"radiation=ultrasound"}), edge, 0.02 * edge);
}

TEST(Sensors, WhatIsTooNearOrTooFarIsInfinite) {
  EXPECT_EQ(range_to({0.02, 0, 0}, {-1, 0, 0}, {}), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(range_to({4.5, 0, 0}, {-1, 0, 0}, {}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(range_to({-1, 0, 0}, {-1, 0, 0}, {}), std::numeric_limits<double>::infinity());  // behind it
}

TEST(Sensors, NoiseOfRangesHasItsFigures) {
  const SensorSite site = site_at({}, {2, 0, 0}, {-1, 0, 0});
  const auto meter = make_sensor("range_finders", {"radiation=ultrasound", "range_noise=0.02", "range_step=0"}).start(site, 7);
  double sum = 0, squares = 0;
  constexpr int kReadings = 4000;
  for (int i = 0; i < kReadings; ++i) {
    const double error = meter->read(i * 0.05).at(0) - 2;
    sum += error, squares += error * error;
  }
  EXPECT_NEAR(sum / kReadings, 0, 4 * 0.02 / std::sqrt(double(kReadings)));
  EXPECT_NEAR(std::sqrt(squares / kReadings), 0.02, 0.001);
}

TEST(Sensors, ABumperReportsTheLargestForceSinceTheReadingBefore) {
  SensorSite site = site_at({});
  std::vector<std::pair<double, double>> asked;
  site.contact_force = [&](const std::vector<std::string>& links, double from, double to) {
    EXPECT_EQ(links, std::vector<std::string>{"bow"});
    asked.push_back({from, to});
    return to > 0.03 ? 5.0 : 0.5;
  };
  const auto meter = make_sensor("bumpers", {"links=bow", "threshold=2"}).start(site, 1);
  EXPECT_EQ(meter->read(0), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(meter->read(0.02), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(meter->read(0.04), (std::vector<double>{1, 5}));
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_EQ(asked[2], (std::pair<double, double>{0.02, 0.04}));  // without a gap
}

TEST(Sensors, ABatteryGivesWhatMotorsAndElectronicsDraw) {
  SensorSite site = site_at({});
  site.motor_work = [](double from, double to) { return to > 10 ? 60 * (to - from) : 0; };  // 60 W after 10 s
  const auto meter = make_sensor("batteries", {"cells=6", "capacity_ah=2", "resistance=0.1", "idle_power=25", "efficiency=0.5"}).start(site, 1);
  const std::vector<double> full = meter->read(0);
  EXPECT_EQ(full[2], 1);
  EXPECT_NEAR(full[0] * full[1], 25, 1e-9) << "the power at its poles";
  EXPECT_NEAR(full[0] + 0.1 * full[1], 6 * 4.2, 1e-9) << "the drop over its resistance";
  double drawn = 0;  // unit: A s
  for (int i = 1; i <= 100; ++i) {
    const std::vector<double> reading = meter->read(i * 0.1);
    drawn += reading[1] * 0.1;
    EXPECT_NEAR(reading[2], 1 - drawn / 7200, 1e-12);
  }
  const std::vector<double> driven = meter->read(10.5);
  EXPECT_NEAR(driven[0] * driven[1], 25 + 120, 1e-9);
}

TEST(Sensors, ABatteryGivesNoMoreThanItCan) {
  SensorSite site = site_at({});
  site.motor_work = [](double from, double to) { return 1e6 * (to - from); };
  const auto weak = make_sensor("batteries", {"cells=1", "resistance=0.1", "charge=0.5"}).start(site, 1);
  const std::vector<double> reading = weak->read(1);
  EXPECT_NEAR(reading[0], 3.75 / 2, 1e-9) << "half of the voltage, at the most power";
  EXPECT_NEAR(reading[1], 3.75 / 0.2, 1e-9);
  const auto empty = make_sensor("batteries", {"capacity_ah=0.001"}).start(site, 1);
  empty->read(1);
  const std::vector<double> none = empty->read(2);
  EXPECT_EQ(none[1], 0);
  EXPECT_EQ(none[2], 0);
}

TEST(Sensors, AnAttitudeWithoutNoiseIsTheOrientation) {
  const Quat q = portable::quat_from_rpy(0.3, -0.2, 2.5);
  const SensorSite site = site_at({q, {}});
  const std::vector<double> read = make_sensor("attitudes", {"noise=false"}).start(site, 1)->read(0);
  EXPECT_NEAR(read[0], q.x, 1e-15);
  EXPECT_NEAR(read[1], q.y, 1e-15);
  EXPECT_NEAR(read[2], q.z, 1e-15);
  EXPECT_NEAR(read[3], q.w, 1e-15);
}

TEST(Sensors, AnAttitudeDriftsAsAGaussMarkovProcess) {
  const SensorSite site = site_at({});
  double heading2 = 0, later = 0, tilt2 = 0;
  constexpr int kSeeds = 1500;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto meter = make_sensor("attitudes", {"noise_deg=0", "drift_time=2", "rate_hz=1"}).start(site, std::uint64_t(seed));
    const auto heading = [&](double t) {
      const std::vector<double> q = meter->read(t);
      tilt2 += 4 * q[0] * q[0] / 3;
      return 2 * portable::asin(q[2]) / kDegree;
    };
    const double first = heading(0);
    heading(1);
    later += first * heading(2);  // one correlation time later
    heading2 += first * first;
  }
  EXPECT_NEAR(std::sqrt(heading2 / kSeeds), 2, 0.12);
  EXPECT_NEAR(later / heading2, std::exp(-1.0), 0.08);
  EXPECT_NEAR(std::sqrt(tilt2 / kSeeds) / kDegree, 0.5, 0.03);
}

// A drift that is over before the next reading is white noise.
TEST(Sensors, ADriftMayBeFasterThanTheReadings) {
  for (const double drift_time : {1e-9, 5e-4, 1e-3}) {
    ErrorFigures figures;
    figures.drift = 2, figures.drift_time = drift_time;
    SensorError error(figures, 3, "x", 1);
    double sum = 0;
    for (int i = 0; i < 4000; ++i) sum += std::pow(error.next(), 2) / 4000;
    EXPECT_NEAR(std::sqrt(sum), 2, 0.1) << drift_time;
  }
}

TEST(Sensors, ABiasWalksWithTheRootOfTime) {
  ErrorFigures figures;
  figures.walk = 0.1;
  double squares = 0;
  constexpr int kSeeds = 2000;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SensorError error(figures, seed, "x", 10);
    double last = 0;
    for (int i = 0; i <= 90; ++i) last = error.next();  // after 9 s
    squares += last * last;
  }
  EXPECT_NEAR(std::sqrt(squares / kSeeds), 0.3, 0.015);
}

TEST(Sensors, PressureIsThatOfTheStandardAtmosphere) {
  const auto pressure = [](double altitude, double z) {
    const SensorSite site = site_at({{}, {0, 0, z}});
    return make_sensor("barometers", {"noise=false", "altitude=" + std::to_string(altitude)}).start(site, 1)->read(0).at(0);
  };
  // ISO 2533, table 1: geopotential altitudes.
  EXPECT_NEAR(pressure(0, 0), 101325, 1e-6);
  EXPECT_NEAR(pressure(1000, 0), 89874.6, 0.5);
  EXPECT_NEAR(pressure(1500, 500), 79495.2, 0.5);
  EXPECT_NEAR(pressure(0, 1) - pressure(0, 0), -12.01, 0.02);  // a storey is 36 Pa
}

TEST(Sensors, TheFieldPointsNorthAndDown) {
  // 50 uT at 60 degrees down, magnetic north 10 degrees east of north, which is +Y.
  const std::vector<std::string> figures{"noise=false", "field_ut=50", "inclination_deg=60", "declination_deg=10"};
  const SensorSite level = site_at({});
  const std::vector<double> b = make_sensor("magnetometers", figures).start(level, 1)->read(0);
  EXPECT_NEAR(b[0], 25e-6 * portable::sin(10 * kDegree), 1e-12);
  EXPECT_NEAR(b[1], 25e-6 * portable::cos(10 * kDegree), 1e-12);
  EXPECT_NEAR(b[2], -50e-6 * portable::sin(60 * kDegree), 1e-12);
  // Turned to look along +Y: the nose feels the north.
  const SensorSite turned = site_at({portable::quat_from_rpy(0, 0, 90 * kDegree), {}});
  EXPECT_NEAR(make_sensor("magnetometers", figures).start(turned, 1)->read(0)[0], b[1], 1e-12);
}

TEST(Sensors, SatellitesStandWhereTheirOrbitsAre) {
  // At the pole none can be higher than the inclination allows: atan((cos 35 - R/a) / sin 35) = 45.26 degrees.
  double highest = 0;
  int least = 24, most = 0;
  for (double t = 0; t < 86400; t += 300) {
    for (const Vec3& to : find_gps_satellites(90, 0, 1.7e9 + t)) highest = std::max(highest, to.z);
    int seen = 0;
    for (const Vec3& to : find_gps_satellites(42.36, -71.06, 1.7e9 + t)) seen += to.z > portable::sin(5 * kDegree);
    least = std::min(least, seen), most = std::max(most, seen);
  }
  EXPECT_NEAR(portable::asin(highest) / kDegree, 45.26, 0.3);
  // The constellation was made so that at least four are 5 degrees high, everywhere and always; it has 24.
  EXPECT_GE(least, 4);
  EXPECT_LE(most, 12);
  // A sidereal day later all stand where they stood.
  const std::vector<Vec3> now = find_gps_satellites(10, 20, 1.7e9), later = find_gps_satellites(10, 20, 1.7e9 + 86164.0905);
  for (std::size_t i = 0; i < now.size(); ++i) EXPECT_LT(distance(now[i], later[i]), 1e-4);
}

SensorSite open_sky() {
  SensorSite site = site_at({{}, {3, 4, 5}});
  site.latitude_deg = 42.36, site.longitude_deg = -71.06, site.utc_s = 1700000000;
  return site;
}

TEST(Sensors, AReceiverUnderTheSkyIsWhereItIs) {
  const SensorSite site = open_sky();
  const std::vector<double> v = make_sensor("gnss", {"noise=false", "altitude=20"}).start(site, 1)->read(0);
  // East is +X, north +Y; a metre north is 1 / 111074 degree at this latitude, one east 1 / 82385 (WGS 84).
  EXPECT_NEAR((v[0] - 42.36) * 111074, 4, 0.01);
  EXPECT_NEAR((v[1] + 71.06) * 82386, 3, 0.01);
  EXPECT_NEAR(v[2], 25, 1e-9);
  EXPECT_GE(v[3], 4);
  EXPECT_GT(v[4], 0.5);
  EXPECT_LT(v[4], 6);
}

TEST(Sensors, AReceiverUnderARoofHasNoFix) {
  SensorSite site = open_sky();
  site.cast = [](double, const std::vector<Vec3>& directions, double) {
    return std::vector<SensorSite::Hit>(directions.size(), SensorSite::Hit{2, 1, 0.3});
  };
  const SensorItem sensor = make_sensor("gnss");
  const std::vector<double> v = sensor.start(site, 1)->read(0);
  EXPECT_EQ(v[3], 0);
  for (const std::size_t i : {0u, 1u, 2u, 4u, 5u}) EXPECT_TRUE(std::isnan(v[i])) << i;
  const auto observed = std::get<SatelliteObservation>(sensor.figures->observe({0, 1, v}));
  EXPECT_FALSE(observed.fix);
  EXPECT_EQ(observed.latitude_deg, 0);
}

TEST(Sensors, HalfASkyMakesThePositionWorseAndTheCovarianceSaysHowMuch) {
  SensorSite wall = open_sky();
  wall.cast = [](double, const std::vector<Vec3>& directions, double) {
    std::vector<SensorSite::Hit> hits(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i)
      if (directions[i].x > 0.35) hits[i] = {1, 1, 0.3};
    return hits;
  };
  const SensorSite open = open_sky();
  const SensorItem sensor = make_sensor("gnss");
  const double clear = sensor.start(open, 1)->read(0)[4], blocked = sensor.start(wall, 1)->read(0)[4];
  EXPECT_GT(blocked, 1.2 * clear);
  double east2 = 0, up2 = 0, east_variance = 0, up_variance = 0;
  constexpr int kSeeds = 3000;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const std::vector<double> v = sensor.start(wall, seed)->read(0);
    const double east = (v[1] + 71.06) * 82386 - 3, up = v[2] - 5;
    east2 += east * east, up2 += up * up, east_variance += v[5], up_variance += v[7];
  }
  EXPECT_NEAR(east2 / east_variance, 1, 0.1);
  EXPECT_NEAR(up2 / up_variance, 1, 0.1);
}

TEST(Sensors, SensorsOfAKindHaveNoiseOfTheirOwn) {
  const SensorSite site = site_at({}, {2, 0, 0}, {-1, 0, 0});
  SensorItem a = make_sensor("range_finders", {"range_step=0"}), b = a;
  b.name = "other";
  EXPECT_NE(a.start(site, 3)->read(0), b.start(site, 3)->read(0));
  EXPECT_EQ(a.start(site, 3)->read(0), a.start(site, 3)->read(0));
  EXPECT_NE(a.start(site, 3)->read(0), a.start(site, 4)->read(0));
}

TEST(Sensors, EveryKindHasItsFileAndItsColumns) {
  std::set<std::string> keys;
  for (const SensorKind* kind : sensor_kinds()) {
    EXPECT_TRUE(keys.insert(kind->key()).second) << kind->key();
    EXPECT_FALSE(kind->topics().empty()) << kind->key();
    SensorSite site = site_at({});
    site.contact_force = [](const auto&, double, double) { return 0.0; };
    site.motor_work = [](double, double) { return 0.0; };
    site.rays = std::make_shared<RayWorld>(Scene());
    site.air = std::make_shared<const Medium>(AirSpec(), 1);
    const auto meter = kind->start(site, std::nullopt, 10);
    EXPECT_EQ(meter->read(0).size(), kind->columns().size()) << kind->key();
    const auto scan = meter->scan(0);
    EXPECT_EQ(scan != nullptr, kind->columns().empty()) << "numbers or scans: " << kind->key();
    EXPECT_LE(scan ? double(scan->points.size()) : 0, kind->most_points()) << kind->key();
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RUBBLE_SOURCE_DIR "/scripting/sensors")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    files += text.find("std::unique_ptr<SensorKind> make_" + entry.path().stem().string() + "()") != std::string::npos;
  }
  EXPECT_EQ(files, sensor_kinds().size()) << "a kind without its name in RUBBLE_SENSORS of scripting/CMakeLists.txt";
}

std::string mistakes_of(const std::string& lua) {
  try {
    load_mission_text(lua, "m.lua");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Sensors, TheOnlyOneOfItsTopicHasItWithoutItsName) {
  const auto topics = [](const std::string& lua) {
    const Scenario s = load_mission_text("return rubble.mission { " + lua + " }", "m.lua").scenario;
    std::vector<std::string> list;
    for (const SensorItem& sensor : s.sensors) list.push_back(topic_of(s.sensors, sensor));
    return list;
  };
  using List = std::vector<std::string>;
  EXPECT_EQ(topics("lidars = { a = {}, flat = { model = 'utm30lx' } }, gnss = { g = {} }"), (List{"/points", "/scan", "/g"}));
  EXPECT_EQ(topics("lidars = { a = {}, b = { model = 'os0' } }"), (List{"/a/points", "/b/points"}));
  EXPECT_EQ(topics("lidars = { a = {}, b = { topic = '/own' } }"), (List{"/points", "/own"}));
}

TEST(Sensors, FilesOfScansNeedASensorThatScans) {
  EXPECT_NE(mistakes_of("return rubble.mission { gnss = { g = {} }, outputs = { pcd = true } }")
                .find("outputs.pcd: there is nothing to write: expected a mission with `lidars`"), std::string::npos);
  EXPECT_EQ(mistakes_of("return rubble.mission { lidars = { l = {} }, outputs = { pcd = true, kitti = true } }"), "");
}

TEST(Sensors, MistakesNameTheirKeys) {
  EXPECT_NE(mistakes_of("return rubble.mission { bumpers = { bow = {} } }").find("bumpers.bow.ride: a sensor of this kind must be on a robot"),
            std::string::npos);
  EXPECT_NE(mistakes_of("return rubble.mission { range_finders = { a = { min_range = 5 } } }").find("range_finders.a.max_range"),
            std::string::npos);
  EXPECT_NE(mistakes_of("return rubble.mission { range_finders = { a = {} }, gnss = { a = {} } }").find("the name is taken"),
            std::string::npos);
  EXPECT_NE(mistakes_of("return rubble.mission { barometers = { b = { presure_noise = 1 } } }").find("pressure_noise"), std::string::npos);
  EXPECT_NE(mistakes_of("return rubble.mission { attitudes = { Bad = {} } }").find("not a name of a sensor"), std::string::npos);
  EXPECT_EQ(mistakes_of("return rubble.mission { magnetometers = { m = { rate_hz = 10 } }, gnss = { g = {} } }"), "");
}

TEST(Sensors, AScenarioWithSensorsComesBackFromItsText) {
  const Scenario s = load_mission_text(
      "return rubble.mission { gnss = { g = { mask_deg = 12.5, position = { 0, 0, 1 } } }, "
      "range_finders = { b = { max_range = 3.25 }, a = { noise = false } } }", "m.lua").scenario;
  ASSERT_EQ(s.sensors.size(), 3u);
  EXPECT_EQ(s.sensors[0].key(), "range_finders.a");  // in the order of kinds, then by name
  EXPECT_EQ(s.sensors[2].key(), "gnss.g");
  const std::string text = scenario_to_json(s);
  EXPECT_EQ(scenario_to_json(scenario_from_json(text, "it")), text);
  EXPECT_NE(text.find("3.25"), std::string::npos);
}

}  // namespace sensors_test
}  // namespace rubble
