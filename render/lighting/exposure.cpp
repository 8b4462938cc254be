#include "render/lighting/exposure.h"

#include <algorithm>
#include <cstddef>

#include "kernel/base/portable_math.h"

namespace rubble {

namespace {

constexpr double kLog2 = 0.6931471805599453;

double exp2_portable(double x) { return portable::exp(x * kLog2); }

// How bright a scene of the mean luminance L is shown, as a share of how bright at noon.
double shown_brightness(double kcd_per_m2, double least) {
  const auto key = [](double l) {
    return 1.03 - 2 / (2 + portable::log(l * 1000 + 1) / portable::log(10));
  };
  constexpr double kNoon = 4;  // unit: kcd/m2
  return std::clamp(key(kcd_per_m2) / key(kNoon), least, 1.0);
}

}  // namespace

float find_exposure(const ExposureOptions& options, const MeteredImage& image) {
  constexpr float kNothing = -1000;
  constexpr double kUnknown = 0.1, kDarkest = -40;  // unit of the latter: stops from 1 kcd/m2
  if (options.fixed > 0) return float(options.fixed);
  double sum = 0, weights = 0;
  const int w = image.width, h = image.height;
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const float stops = image.stops[std::size_t(y) * std::size_t(w) + std::size_t(x)];
      if (!(stops > kNothing)) continue;
      const bool middle = 4 * x > w && 4 * x < 3 * w && 4 * y > h && 4 * y < 3 * h;
      const double weight = middle ? 2 : 1;
      sum += weight * std::max(double(stops), kDarkest);
      weights += weight;
    }
  }
  if (weights == 0) return float(kUnknown);
  const double stops = sum / weights;
  const double brightness = shown_brightness(exp2_portable(stops), options.dusk);
  return float(std::clamp(options.key * brightness * exp2_portable(-stops), 1e-5, 1e6));
}

}  // namespace rubble
