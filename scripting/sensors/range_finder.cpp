// A range finder with a single beam: a cone in which it sees one distance.
//
// Infrared (time of flight): the mean over the cone, weighted by the light that comes back from each direction, which is
// reflectance * cosine / distance^2 of a Lambertian surface. Ultrasound: the nearest surface in the cone, whose echo comes
// first. Defaults: ST VL53L1X (data sheet DS12385: full field of view 27 degrees, 4 cm to 4 m, error of +-20 mm, of which
// the noise is a third).
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/ros/ros_messages.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "scripting/sensors/sensor_error.h"
#include "scripting/sensors/sensor_kind.h"

namespace rubble {
namespace {

constexpr int kRays = 64;  // over the cone
constexpr double kDegree = portable::kPi / 180;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

enum class Radiation { infrared, ultrasound };

struct RangeFinderFigures {
  Radiation radiation = Radiation::infrared;
  double field_of_view_deg = 27;
  double min_range = 0.04, max_range = 4;
  double range_noise = 0.007, range_step = 0.001;
};

// The axis, then a golden-angle spiral to the edge; each stands for the same solid angle.
std::vector<Vec3> cone_directions(double full_angle) {
  std::vector<Vec3> directions{{1, 0, 0}};
  const double golden = portable::kPi * (3 - std::sqrt(5.0)), edge = portable::cos(full_angle / 2);
  for (int i = 1; i < kRays; ++i) {
    const double x = 1 - (1 - edge) * i / (kRays - 1), across = std::sqrt(std::max(0.0, 1 - x * x));
    const auto [s, c] = portable::sincos(golden * i);
    directions.push_back({x, across * c, across * s});
  }
  return directions;
}

// A multiple of the step; of one that divides 1, the number that is nearest to it as decimals are written.
double round_to(double value, double step) {
  const double whole = std::floor(1 / step + 0.5), count = std::floor(value / step + 0.5);
  return std::fabs(whole * step - 1) < 1e-9 ? count / whole : count * step;
}

class RangeFinderMeter : public SensorMeter {
 public:
  RangeFinderMeter(const SensorSite& site, const RangeFinderFigures& figures, std::optional<std::uint64_t> seed, double rate_hz)
      : site_(site), figures_(figures), cone_(cone_directions(figures.field_of_view_deg * kDegree)),
        error_({figures.range_noise}, seed, "range", rate_hz) {}

  std::vector<double> read(double t) override {
    const Quat turn = site_.world_from_sensor(t).rotation;
    std::vector<Vec3> directions;
    for (const Vec3& direction : cone_) directions.push_back(turn.rotate(direction));
    const double exact = combine(site_.cast(t, directions, figures_.max_range)), error = error_.next();
    if (std::isinf(exact)) return {exact};
    double range = exact + error;
    if (figures_.range_step > 0) range = round_to(range, figures_.range_step);
    // REP 117: what is too near is -Inf, what is too far +Inf.
    if (range < figures_.min_range) return {-kInfinite};
    return {range > figures_.max_range ? kInfinite : range};
  }

 private:
  double combine(const std::vector<SensorSite::Hit>& hits) const {
    double nearest = kInfinite, sum = 0, weights = 0;
    for (const SensorSite::Hit& hit : hits) {
      if (hit.distance < 0) continue;
      nearest = std::min(nearest, hit.distance);
      const double weight = hit.reflectance * hit.cosine / std::max(1e-6, hit.distance * hit.distance);
      sum += weight * hit.distance, weights += weight;
    }
    return figures_.radiation == Radiation::ultrasound || weights <= 0 ? nearest : sum / weights;
  }

  const SensorSite& site_;
  RangeFinderFigures figures_;
  std::vector<Vec3> cone_;
  SensorError error_;
};

class RangeFinder : public SensorKind {
 public:
  std::string key() const override { return "range_finders"; }
  std::string title() const override { return "range finder"; }
  std::string example() const override { return "front"; }
  std::string doc() const override {
    return "Range finders with a single beam along X, infrared or ultrasonic. A reading is one distance: infinite beyond "
           "`max_range`, minus infinite below `min_range` (REP 117).";
  }
  double usual_rate_hz() const override { return 20; }
  bool casts_rays() const override { return true; }
  std::unique_ptr<SensorKind> clone() const override { return std::make_unique<RangeFinder>(*this); }

  void add_keys(Schema& k) override {
    k.choice("radiation", f_.radiation, {"infrared", "ultrasound"},
             "`infrared`: the mean distance in the cone, weighted by the light that returns. `ultrasound`: the nearest.");
    k.value("field_of_view_deg", f_.field_of_view_deg, "Full angle of the cone.").above(0, 120).unit("degree");
    k.value("min_range", f_.min_range, "Nearest distance.").between(0, 100).unit("m");
    k.value("max_range", f_.max_range, "Farthest distance.").above(0, 200).unit("m");
    k.value("range_noise", f_.range_noise, "Standard deviation of a reading.").between(0, 1).unit("m");
    k.value("range_step", f_.range_step, "Resolution; 0: not rounded.").between(0, 1).unit("m");
  }
  std::vector<Diagnostic> find_mistakes() const override {
    if (f_.min_range < f_.max_range) return {};
    return {{"", 0, "max_range", "the range is empty", "more than min_range, " + exact_text(f_.min_range) + " m",
             exact_text(f_.max_range), ""}};
  }

  std::unique_ptr<SensorMeter> start(const SensorSite& site, std::optional<std::uint64_t> seed, double rate_hz) const override {
    return std::make_unique<RangeFinderMeter>(site, f_, seed, rate_hz);
  }

  std::vector<ReadingColumn> columns() const override { return {{"range", "m"}}; }
  std::vector<Topic> topics() const override { return {{"", &ros::kRange}}; }
  std::string message(std::size_t, ros::Version version, const ros::Header& header, const Reading& reading) const override {
    return ros::range(version, header, f_.radiation == Radiation::infrared, f_.field_of_view_deg * kDegree, f_.min_range,
                      f_.max_range, reading.values[0]);
  }
  RawlogObservation observe(const Reading& reading) const override {
    return RangeObservation{f_.min_range, f_.max_range, reading.values[0], f_.field_of_view_deg * kDegree};
  }

 private:
  RangeFinderFigures f_;
};

}  // namespace

std::unique_ptr<SensorKind> make_range_finder() { return std::make_unique<RangeFinder>(); }

}  // namespace rubble
