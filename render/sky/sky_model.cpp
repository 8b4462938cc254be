#include "render/sky/sky_model.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {

namespace {

constexpr float kSunsetOvercast = 0.3f;  // unit: klx
// Of the clear sky's model at sunset, to which clear_dusk is compared; unit: klx
constexpr float kSunsetClear = 0.72f;
// 3000 K in linear sRGB, of the luminance 1.
const Vec3f kStreetLamp(1.72f, 0.87f, 0.28f);

}  // namespace

float hazy_illuminance(float clear, float lost, float sine) {
  if (sine <= 0) return clear;
  const float upwards = std::clamp((2 - 3 * 0.76f * sine) / 4, 0.0f, 0.5f);
  return clear + lost * sine * 0.94f * (1 - upwards);
}

float overcast_illuminance(double sun_elevation_deg, float clear_dusk) {
  if (sun_elevation_deg < 0) return kSunsetOvercast * std::min(1.0f, clear_dusk / kSunsetClear);
  return kSunsetOvercast + 21 * float(portable::sin(sun_elevation_deg * portable::kPi / 180));
}

Vec3f overcast_radiance(float sine, float horizontal_klx) {
  const float zenith = 9 / (7 * portable::kPiF) * horizontal_klx;
  return Vec3f(1, 1, 1) * (zenith * (1 + 2 * std::max(sine, 0.0f)) / 3);
}

float cie_clear_ratio(float sine, float sun_sine, float sun_cosine) {
  constexpr double a = -1, b = -0.32, c = 10, d = -3, e = 0.45;
  const auto gradation = [](double cosine_of_zenith) {
    return 1 + a * portable::exp(b / std::max(cosine_of_zenith, 1e-3));
  };
  const auto indicatrix = [](double cosine) {
    const double angle = portable::acos(std::clamp(cosine, -1.0, 1.0));
    return 1 + c * (portable::exp(d * angle) - portable::exp(d * portable::kPi / 2)) + e * cosine * cosine;
  };
  return float(gradation(double(sine)) * indicatrix(double(sun_cosine)) /
               (gradation(1) * indicatrix(double(sun_sine))));
}

Vec3f city_glow(float sine) {
  const float low = 1 - std::clamp(sine, 0.0f, 1.0f);
  return kStreetLamp * (3e-6f * (1 + 4 * low * low * low));
}

}  // namespace rubble
