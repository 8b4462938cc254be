#include "render/media/precipitation.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr double kFlakeDensity = 0.17;      // of a flake of 1 mm; unit: g/cm3
constexpr double kRainReach = 4, kSnowReach = 3;     // of a drop of 1 mm; our choice; unit: m
constexpr double kFarthestRain = 16, kFarthestSnow = 8;  // our choice; unit: m

}  // namespace

Precipitation::Precipitation(PrecipitationKind kind, double rate) : kind_(kind) {
  const bool rain = kind == PrecipitationKind::rain;
  n0_ = rain ? 8000 : 3800 * quick::pow(rate, -0.87);
  slope_ = rain ? 4.1 * quick::pow(rate, -0.21) : 2.55 * quick::pow(rate, -0.48);
  all_ = extinction(0, 1000);
}

double Precipitation::count(double low, double high) const {
  return n0_ / slope_ * (quick::exp(-slope_ * low) - quick::exp(-slope_ * high));
}

double Precipitation::draw(double low, double high, double random) const {
  const double first = quick::exp(-slope_ * low), last = quick::exp(-slope_ * high);
  return std::clamp(-quick::log(first - random * (first - last)) / slope_, low, high);
}

double Precipitation::diameter(double melted) const {
  return kind_ == PrecipitationKind::rain ? melted : std::sqrt(melted * melted * melted / kFlakeDensity);
}

double Precipitation::fall_speed(double melted) const {
  if (kind_ == PrecipitationKind::snow) return 1.6 * quick::pow(melted / 10, 0.3);
  return std::max(0.0, 9.65 - 10.3 * quick::exp(-0.6 * melted));
}

double Precipitation::moment(double x) const {
  const double y = slope_ * x, s = slope_;
  if (kind_ == PrecipitationKind::rain) return (2 - quick::exp(-y) * (y * y + 2 * y + 2)) / (s * s * s);
  return (6 - quick::exp(-y) * (y * y * y + 3 * y * y + 6 * y + 6)) / (s * s * s * s);
}

double Precipitation::extinction(double low, double high) const {
  const double disc = portable::kPi / 4 * 1e-6 / (kind_ == PrecipitationKind::rain ? 1 : kFlakeDensity);
  return disc * n0_ * (moment(high) - moment(low));
}

double Precipitation::smallest() const { return kind_ == PrecipitationKind::rain ? 0.5 : 0.3; }

double Precipitation::largest() const { return 8; }

double Precipitation::reach(double melted) const {
  return kind_ == PrecipitationKind::rain ? std::min(kRainReach * melted, kFarthestRain)
                                          : std::min(kSnowReach * diameter(melted), kFarthestSnow);
}

double Precipitation::veil(double distance) const {
  const bool rain = kind_ == PrecipitationKind::rain;
  if (distance >= (rain ? kFarthestRain : kFarthestSnow)) return all_;
  const double seen = distance / (rain ? kRainReach : kSnowReach);
  const double melted = rain ? seen : quick::cbrt(kFlakeDensity * seen * seen);
  return extinction(0, std::max(melted, smallest())) + extinction(largest(), 1000);
}

}  // namespace rubble
