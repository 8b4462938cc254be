#include "render/exposure.h"

#include <algorithm>
#include <cmath>

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

void AutoExposure::follow(const std::vector<std::uint8_t>& rgba, int width, int height,
                          double elapsed) {
  if (options_.fixed > 0) {
    factor_ = float(options_.fixed);
    settled_ = true;
    return;
  }
  // Mean of the logarithm of luminance, the middle counting double; every 4th pixel will do.
  std::int64_t sum = 0, weight = 0;
  for (int y = 2; y < height; y += 4) {
    for (int x = 2; x < width; x += 4) {
      const bool middle =
          x > width / 4 && x < width * 3 / 4 && y > height / 4 && y < height * 3 / 4;
      const int w = middle ? 2 : 1;
      sum += w * rgba[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 4 + 3];
      weight += w;
    }
  }
  if (!weight) return;
  const double stops = (double(sum) / double(weight) / 255 - 0.5) * 24;
  const double brightness =
      shown_brightness(exp2_portable(stops) / double(factor_), options_.dusk);
  const double wanted = portable::log(options_.key * brightness) / kLog2 - stops;
  double share = 1;
  if (settled_) share = 1 - portable::exp(-std::clamp(elapsed / options_.seconds, 0.0, 50.0));
  factor_ = float(std::clamp(double(factor_) * exp2_portable(wanted * share), 1e-5, 1e6));
  if (std::fabs(wanted) < 0.15) settled_ = true;
}

}  // namespace rubble
