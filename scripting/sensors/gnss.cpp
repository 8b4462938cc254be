// A GNSS receiver: a position from the satellites of GPS that it sees; under a roof it sees none.
//
// A satellite counts that is above the mask and that no surface hides. Each has an error of its range that drifts as a
// first-order Gauss-Markov process, and white noise. The position is the least-squares solution of the ranges for place and
// clock, so what hides a part of the sky makes it worse as it does in reality (dilution of precision; e.g. Kaplan and
// Hegarty, Understanding GPS, chapter 7). Fewer than four: no fix. Reflected signals are left out.
#include <cmath>
#include <limits>

#include "io/ros/ros_messages.h"
#include "kernel/base/portable_math.h"
#include "scripting/sensors/gps_constellation.h"
#include "scripting/sensors/sensor_error.h"
#include "scripting/sensors/sensor_kind.h"

namespace rubble {
namespace {

constexpr double kRadianOfDegree = portable::kPi / 180;
constexpr double kClearSky = 500;        // what is farther hides no satellite; unit: m
constexpr double kSlowest = 1e-9;        // of a pivot: below, the satellites stand in no useful order
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
enum Value { kLatitude, kLongitude, kAltitude, kSatellites, kHdop, kEastVariance, kNorthVariance, kUpVariance, kValues };

struct GnssFigures {
  double altitude = 0, mask_deg = 10;
  double range_drift = 3, drift_time = 100, range_noise = 0.3;
};

using Matrix4 = double[4][4];

// By Gauss-Jordan with the largest pivot; false: it has none.
bool invert(Matrix4& m, Matrix4& inverse) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) inverse[i][j] = i == j;
  for (int column = 0; column < 4; ++column) {
    int pivot = column;
    for (int row = column + 1; row < 4; ++row)
      if (std::fabs(m[row][column]) > std::fabs(m[pivot][column])) pivot = row;
    if (std::fabs(m[pivot][column]) < kSlowest) return false;
    for (int j = 0; j < 4; ++j) std::swap(m[pivot][j], m[column][j]), std::swap(inverse[pivot][j], inverse[column][j]);
    const double by = 1 / m[column][column];
    for (int j = 0; j < 4; ++j) m[column][j] *= by, inverse[column][j] *= by;
    for (int row = 0; row < 4; ++row) {
      if (row == column) continue;
      const double less = m[row][column];
      for (int j = 0; j < 4; ++j) m[row][j] -= less * m[column][j], inverse[row][j] -= less * inverse[column][j];
    }
  }
  return true;
}

class GnssMeter : public SensorMeter {
 public:
  GnssMeter(const SensorSite& site, const GnssFigures& f, std::optional<std::uint64_t> seed, double rate_hz)
      : site_(site), f_(f), variance_(seed ? f.range_drift * f.range_drift + f.range_noise * f.range_noise : 0) {
    for (std::size_t i = 0; i < find_gps_satellites(0, 0, 0).size(); ++i)
      errors_.emplace_back(ErrorFigures{f.range_noise, 0, 0, f.range_drift, f.drift_time}, seed, "satellite " + std::to_string(i), rate_hz);
    const auto [s, c] = portable::sincos(site.north_deg * kRadianOfDegree);
    north_ = {c, s, 0}, east_ = {s, -c, 0};
  }

  std::vector<double> read(double t) override {
    std::vector<double> errors;
    for (SensorError& error : errors_) errors.push_back(error.next());
    std::vector<double> reading(kValues, kNothing);
    const std::vector<Vec3> to = find_gps_satellites(site_.latitude_deg, site_.longitude_deg, double(site_.utc_s) + t);
    const std::vector<std::size_t> seen = find_seen(to, t);
    reading[kSatellites] = double(seen.size());
    Matrix4 normal{}, inverse{};
    double right[4] = {};
    for (const std::size_t i : seen) {
      const double row[4] = {-to[i].x, -to[i].y, -to[i].z, 1};
      for (int a = 0; a < 4; ++a) {
        right[a] += row[a] * errors[i];
        for (int b = 0; b < 4; ++b) normal[a][b] += row[a] * row[b];
      }
    }
    if (seen.size() < 4 || !invert(normal, inverse)) return reading;
    double error[3] = {};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 4; ++b) error[a] += inverse[a][b] * right[b];
    reading[kHdop] = std::sqrt(inverse[0][0] + inverse[1][1]);
    for (int a = 0; a < 3; ++a) reading[std::size_t(kEastVariance + a)] = variance_ * inverse[a][a];
    const Vec3 place = site_.world_from_sensor(t).translation;
    put_place({dot(place, east_) + error[0], dot(place, north_) + error[1], place.z + error[2]}, reading);
    return reading;
  }

 private:
  // Above the mask, with nothing in the way.
  std::vector<std::size_t> find_seen(const std::vector<Vec3>& to, double t) const {
    const double lowest = portable::sin(f_.mask_deg * kRadianOfDegree);
    std::vector<std::size_t> above, seen;
    std::vector<Vec3> directions;
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (to[i].z < lowest) continue;
      above.push_back(i);
      directions.push_back(east_ * to[i].x + north_ * to[i].y + Vec3{0, 0, to[i].z});
    }
    if (above.empty()) return seen;
    const std::vector<SensorSite::Hit> hits = site_.cast(t, directions, kClearSky);
    for (std::size_t k = 0; k < above.size(); ++k)
      if (hits[k].distance < 0) seen.push_back(above[k]);
    return seen;
  }

  // By the radii of curvature of WGS 84 at the world's origin. local: east, north, up; unit: m
  void put_place(const Vec3& local, std::vector<double>& reading) const {
    constexpr double kAxis = 6378137, kEccentricity2 = 6.69437999014e-3;  // unit: m, 1
    const auto [s, c] = portable::sincos(site_.latitude_deg * kRadianOfDegree);
    const double root = std::sqrt(1 - kEccentricity2 * s * s);
    const double across = kAxis / root, along = kAxis * (1 - kEccentricity2) / (root * root * root);
    reading[kLatitude] = site_.latitude_deg + local.y / (along + f_.altitude) / kRadianOfDegree;
    reading[kLongitude] = site_.longitude_deg + local.x / ((across + f_.altitude) * c) / kRadianOfDegree;
    reading[kAltitude] = f_.altitude + local.z;
  }

  const SensorSite& site_;
  GnssFigures f_;
  double variance_;                  // of a range; unit: m2
  std::vector<SensorError> errors_;  // by satellite
  Vec3 east_, north_;
};

class Gnss : public SensorKind {
 public:
  std::string key() const override { return "gnss"; }
  std::string title() const override { return "GNSS receiver"; }
  std::string example() const override { return "gps"; }
  std::string doc() const override {
    return "GNSS receivers: position on Earth from the GPS satellites in view. Pieces, buildings and terrain hide satellites; "
           "with fewer than four there is no fix. Place, time and north are those of `light`, else Boston at the first stamp.";
  }
  double usual_rate_hz() const override { return 5; }
  bool casts_rays() const override { return true; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<Gnss>(*this); }

  void add_keys(Schema& k) override {
    k.value("altitude", f_.altitude, "Of the ground z = 0 above the ellipsoid.").between(-500, 9000).unit("m");
    k.value("mask_deg", f_.mask_deg, "Lower satellites are not used.").between(0, 90).unit("degree");
    k.value("range_drift", f_.range_drift, "Standard deviation of the slow error of each satellite's range.").between(0, 1000).unit("m");
    k.value("drift_time", f_.drift_time, "Correlation time of the slow errors.").above(0, 1e6).unit("s");
    k.value("range_noise", f_.range_noise, "Standard deviation of white noise of each range.").between(0, 1000).unit("m");
  }
  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t> seed, double rate_hz) const override {
    return std::make_unique<GnssMeter>(site, f_, seed, rate_hz);
  }

  std::vector<ReadingColumn> columns() const override {
    return {{"latitude", "degree"}, {"longitude", "degree"}, {"altitude", "m"}, {"satellites", ""},
            {"hdop", ""}, {"east_variance", "m2"}, {"north_variance", "m2"}, {"up_variance", "m2"}};
  }
  std::vector<Topic> topics() const override { return {{"", &ros::kNavSatFix}}; }
  std::string message(std::size_t, ros::Version version, const ros::Header& header, const Reading& r) const override {
    const std::vector<double>& v = r.values;
    return ros::nav_sat_fix(version, header, has_fix(r), v[kLatitude], v[kLongitude], v[kAltitude],
                            {v[kEastVariance], v[kNorthVariance], v[kUpVariance]});
  }
  RawlogObservation observe(const Reading& r) const override {
    const std::vector<double>& v = r.values;
    SatelliteObservation observation;
    observation.fix = has_fix(r), observation.satellites = int(v[kSatellites]);
    if (!observation.fix) return observation;
    observation.latitude_deg = v[kLatitude], observation.longitude_deg = v[kLongitude];
    observation.altitude = v[kAltitude], observation.hdop = v[kHdop];
    return observation;
  }

 private:
  static bool has_fix(const Reading& reading) { return !std::isnan(reading.values[kLatitude]); }
  GnssFigures f_;
};

}  // namespace

std::unique_ptr<SensorKind> make_gnss() { return std::make_unique<Gnss>(); }

}  // namespace rubble
