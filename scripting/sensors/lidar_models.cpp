// The figures of real LiDARs, as their makers publish them. Where a data sheet is silent it is said so.
//
// vlp16: Velodyne LiDAR 63-9243, "VLP-16 user manual": 16 lasers from -15 to +15 degrees, fired one every
//   2.304 us in the order -15, 1, -13, 3, ..., a cycle of 55.296 us, 5 to 20 turns a second, 100 m,
//   accuracy 3 cm (here two standard deviations), steps of 2 mm, 3.0 by 1.5 mrad (here their mean, in
//   both directions), dual returns at least 1 m apart. range_at_10_percent: as if the 100 m were stated
//   for 80 %, our choice. The small differences of height and azimuth from laser to laser are left out.
// os0, os1, os2: Ouster, data sheets of the first generation: 90, 45 and 22.5 degrees (OS1-128), 15, 40
//   and 80 m on 10 %, 50, 120 and 240 m on 80 %, from 0.3, 0.8 and 1 m, 0.35, 0.18 and 0.09 degrees at
//   half the maximum (1.699 times as much at 1/e^2), standard deviation 1.5 cm at good signal (2.5 cm
//   of an OS2). 32, 64 or 128 rings at even spacing fire at once, 512, 1024 or 2048 times a turn.
// mid360: Livox, data sheet of the Mid-360: 360 by 59 degrees (-7 to 52), 200,000 points/s, 10 scans a
//   second, 40 m on 10 %, 70 m on 80 %, from 0.1 m, standard deviation 2 cm at most at 10 m. Pattern and
//   divergence (2.5 mrad) are our choice.
// utm30lx: Hokuyo, specification C-42-3615: 270 degrees in steps of 0.25, 40 turns a second, 0.1 to 30 m,
//   repeatability 1 cm. range_at_10_percent: as if 30 m were stated for white card of 80 %; divergence
//   our choice.
#include <cmath>

#include "kernel/base/portable_math.h"
#include "scripting/sensors/lidar.h"

namespace rubble {
namespace {

constexpr double kGaussWidth = 1.699;                        // width at 1/e^2 over that at 1/2
constexpr double kMrad = 1e3 * portable::kPi / 180;          // of a degree
constexpr double kUsualColumns = 1024, kUsualChannels = 64;  // of Ouster's

std::vector<double> spaced(double low, double high, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(low + (high - low) * i / (count - 1));
  return out;
}

LidarSpec vlp16(double rate_hz) {
  LidarSpec s;
  s.elevations_deg = spaced(-15, 15, 16);
  s.column_ns = 55'296;
  // The lower eight fire first, third, fifth ..., the upper eight between them.
  for (int ring = 0; ring < 16; ++ring) s.delays_ns.push_back(2304 * (ring < 8 ? 2 * ring : 2 * (ring - 8) + 1));
  s.columns = int(1e9 / rate_hz / double(s.column_ns));
  s.span_deg = -360 * s.columns * double(s.column_ns) * 1e-9 * rate_hz;
  s.max_range = 100, s.range_at_10_percent = 100 * std::sqrt(0.125);
  return s;
}

struct OusterFigures {
  const char* name;
  double view_deg, at_10_percent, max_range, min_range, width_deg, noise;
};
constexpr OusterFigures kOuster[] = {{"OS0", 90, 15, 50, 0.3, 0.35, 0.015},
                                     {"OS1", 45, 40, 120, 0.8, 0.18, 0.015},
                                     {"OS2", 22.5, 80, 240, 1, 0.09, 0.025}};

LidarSpec ouster(const OusterFigures& f, int channels, int columns, double rate_hz) {
  LidarSpec s;
  const int rings = channels > 0 ? channels : int(kUsualChannels);
  s.model = std::string(f.name) + "-" + std::to_string(rings);
  s.elevations_deg = spaced(-f.view_deg / 2, f.view_deg / 2, rings);
  s.delays_ns.assign(std::size_t(rings), 0);
  s.columns = columns > 0 ? columns : int(kUsualColumns);
  s.column_ns = std::int64_t(1e9 / rate_hz / s.columns);
  s.min_range = f.min_range, s.max_range = f.max_range, s.range_at_10_percent = f.at_10_percent;
  s.divergence_mrad = f.width_deg * kGaussWidth * kMrad;
  s.range_noise = f.noise, s.range_step = 0.001;
  return s;
}

LidarSpec mid360(double rate_hz) {
  LidarSpec s;
  s.model = "Mid-360", s.pattern = LidarPattern::rosette;
  s.elevations_deg = spaced(-7, 52, 4);  // four lines; the first and the last are the view's edges
  s.column_ns = 20'000;                  // 200,000 points/s of four lines
  s.delays_ns = {0, 5'000, 10'000, 15'000};
  s.columns = int(1e9 / rate_hz / double(s.column_ns));
  s.min_range = 0.1, s.max_range = 70, s.range_at_10_percent = 40;
  s.range_noise = 0.02, s.range_step = 0.001, s.divergence_mrad = 2.5;
  return s;
}

LidarSpec utm30lx(double rate_hz) {
  LidarSpec s;
  s.model = "UTM-30LX", s.pattern = LidarPattern::planar;
  s.elevations_deg = {0}, s.delays_ns = {0};
  s.columns = 1081, s.first_azimuth_deg = -135, s.span_deg = 0.25 * s.columns;
  s.column_ns = std::int64_t(1e9 / rate_hz / 1440);  // 0.25 of 360 degrees
  s.min_range = 0.1, s.max_range = 30, s.range_at_10_percent = 30 * std::sqrt(0.125);
  s.range_noise = 0.01, s.range_step = 0.001, s.divergence_mrad = 2.5;
  return s;
}

LidarSpec figures(const LidarFigures& l) {
  switch (l.model) {
    case LidarModel::os0:
    case LidarModel::os1:
    case LidarModel::os2:
      return ouster(kOuster[int(l.model) - int(LidarModel::os0)], l.channels, l.columns, l.rate_hz.value_or(10));
    case LidarModel::mid360:
      return mid360(l.rate_hz.value_or(10));
    case LidarModel::utm30lx:
      return utm30lx(l.rate_hz.value_or(40));
    case LidarModel::vlp16:
      break;
  }
  return vlp16(l.rate_hz.value_or(10));
}

}  // namespace

const std::vector<std::string>& lidar_model_names() {
  static const std::vector<std::string> names{"vlp16", "os0", "os1", "os2", "mid360", "utm30lx"};
  return names;
}

bool LidarFigures::has_channels() const {
  return model == LidarModel::os0 || model == LidarModel::os1 || model == LidarModel::os2;
}

LidarSpec LidarFigures::spec() const {
  LidarSpec s = figures(*this);
  if (has_channels() && !beam_elevations_deg.empty()) {
    s.elevations_deg = beam_elevations_deg;
    s.delays_ns.assign(s.elevations_deg.size(), 0);
    s.model = s.model.substr(0, 4) + std::to_string(s.rings());
  }
  if (has_channels()) s.azimuths_deg = beam_azimuths_deg;
  s.beam_radius = beam_radius, s.beam_height = beam_height;
  s.regular = !has_own_beams();
  s.rate_hz = rate();
  s.min_range = min_range.value_or(s.min_range), s.max_range = max_range.value_or(s.max_range);
  s.range_at_10_percent = range_at_10_percent.value_or(s.range_at_10_percent);
  s.range_noise = range_noise.value_or(s.range_noise);
  s.range_step = range_step.value_or(s.range_step);
  s.divergence_mrad = divergence_mrad.value_or(s.divergence_mrad);
  s.returns = returns;
  return s;
}

}  // namespace rubble
