#include "render/lidar/scan_pattern.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kRadian = portable::kPi / 180;  // of a degree
constexpr double kTurnRate = 7.6393, kNodRate = 164.721;  // of a rosette; unit: 1/s

Vec3 direction_of(double azimuth, double elevation) {
  const portable::SinCos a = portable::sincos(azimuth), e = portable::sincos(elevation);
  return {e.cos * a.cos, e.cos * a.sin, e.sin};
}

// The fraction of a turn, so that angles stay small however long the sensor runs.
double fraction(double turns) { return turns - std::floor(turns); }

}  // namespace

ScanPattern::ScanPattern(const LidarSpec& spec) : spec_(spec) {
  rays_.reserve(std::size_t(spec.rays()));
  for (int c = 0; c < spec.columns; ++c) {
    const double column_deg = spec.first_azimuth_deg + spec.span_deg * c / spec.columns;
    Vec3 origin;
    if (spec.beam_radius != 0) origin = direction_of(column_deg * kRadian, 0) * spec.beam_radius;
    origin.z = spec.beam_height;
    for (int r = 0; r < spec.rings(); ++r) {
      PatternRay ray;
      ray.offset_ns = c * spec.column_ns + spec.delays_ns[std::size_t(r)];
      ray.ring = std::uint16_t(r), ray.column = std::uint16_t(c);
      const double beside_deg = spec.azimuths_deg.empty() ? 0 : spec.azimuths_deg[std::size_t(r)];
      ray.direction = direction_of((column_deg + beside_deg) * kRadian, spec.elevations_deg[std::size_t(r)] * kRadian);
      ray.origin = origin;
      rays_.push_back(ray);
    }
  }
  std::stable_sort(rays_.begin(), rays_.end(), [](const PatternRay& a, const PatternRay& b) {
    return a.offset_ns < b.offset_ns;
  });
}

std::int64_t ScanPattern::begin_ns(int scan) const { return std::llround(scan * 1e9 / spec_.rate_hz); }

const std::vector<PatternRay>& ScanPattern::rays(int scan) {
  if (spec_.pattern == LidarPattern::rosette && scan != scan_) turn_rosette(scan);
  scan_ = scan;
  return rays_;
}

void ScanPattern::turn_rosette(int scan) {
  const double low = spec_.elevations_deg.front() * kRadian, high = spec_.elevations_deg.back() * kRadian;
  for (PatternRay& ray : rays_) {
    const double t = double(begin_ns(scan) + ray.offset_ns) * 1e-9;
    const double apart = double(ray.ring) / spec_.rings();
    const double nod = portable::sin(2 * portable::kPi * fraction(kNodRate * t + apart));
    ray.direction = direction_of(2 * portable::kPi * fraction(kTurnRate * t + apart),
                                 0.5 * (low + high) + 0.5 * (high - low) * nod);
  }
}

}  // namespace rubble
