#include "render/sensors/fixed_pattern.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/quick_math.h"
#include "render/sensors/noise_field.h"

namespace rubble {

FixedPattern::FixedPattern(const ImageSensorSpec& spec, std::size_t photosites, std::uint64_t seed,
                           int eye)
    : gain_(photosites), offset_(photosites), current_(photosites) {
  const std::uint64_t number = std::uint64_t(eye);
  const NoiseField gain(seed, "sensor/prnu", number), offset(seed, "sensor/dsnu", number);
  const NoiseField hot(seed, "sensor/hot", number);
  for (std::size_t i = 0; i < photosites; ++i) {
    gain_[i] = float(std::max(0.0, 1 + spec.prnu * gain.normal(i)));
    offset_[i] = float(spec.dsnu * offset.normal(i));
    const double more = hot.uniform(2 * i) < spec.hot_pixels
                            ? -spec.hot_current * quick::log(1 - hot.uniform(2 * i + 1))
                            : 0;
    current_[i] = float(spec.dark_current + more);
  }
}

}  // namespace rubble
