#include "render/sensors/image_sensor.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/quick_math.h"
#include "render/sensors/bayer.h"
#include "render/sensors/fixed_pattern.h"
#include "render/sensors/jpeg_loss.h"
#include "render/sensors/noise_field.h"

namespace rubble {

namespace {

constexpr std::size_t kChunk = 1 << 14;  // pixels a job
constexpr double kRed = 0.2126, kGreen = 0.7152, kBlue = 0.0722;  // Rec. 709

double respond(double x, const ImageSensorSpec& spec) {
  if (spec.response == Response::linear) return x;
  if (spec.response == Response::gamma) return quick::pow(x, 1 / spec.gamma);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * quick::pow(x, 1 / 2.4) - 0.055;  // IEC 61966-2-1
}

}  // namespace

ImageSensor::ImageSensor(const CameraSpec& spec, const LensDirections& directions)
    : spec_(spec), most_((1 << spec.sensor.bits) - 1), fall_off_(directions.size()) {
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vec3f& d = directions[i];
    const double cosine = std::max(0.0, double(d.z)), exponent = 4 * spec.sensor.vignette;
    fall_off_[i] = d == Vec3f() ? 0.0f : exponent > 0 ? float(quick::pow(cosine, exponent)) : 1.0f;  // behind the lens, too
  }
  for (int count = 0; count <= most_; ++count) {
    const double value = respond(double(count) / most_, spec.sensor);
    response_.push_back(std::uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0))));
  }
  if (!spec.sensor.has_pattern()) return;
  const std::size_t photosites = directions.size() * (has_mosaic() ? 1 : 3);
  for (int eye = 0; eye < (spec.baseline > 0 ? 2 : 1); ++eye)
    patterns_[std::size_t(eye)] =
        std::make_unique<FixedPattern>(spec.sensor, photosites, spec.seed, eye);
}

ImageSensor::~ImageSensor() = default;

std::vector<std::uint16_t> ImageSensor::count(const std::vector<float>& light,
                                              const ExposureSettings& settings, int frame,
                                              int eye) const {
  const ImageSensorSpec& sensor = spec_.sensor;
  const Intrinsics& k = spec_.intrinsics;
  const NoiseField shot(spec_.seed, "sensor/shot", std::uint64_t(frame) * 2 + std::uint64_t(eye));
  const NoiseField read(spec_.seed, "sensor/read", std::uint64_t(frame) * 2 + std::uint64_t(eye));
  const FixedPattern* const pattern = patterns_[std::size_t(eye)].get();
  const double share = saturation_share(settings, spec_.exposure.f_number);
  const double well = sensor.full_well * 100 / settings.iso;
  // c: of the light; site: of what is counted.
  const auto count_one = [&](std::size_t c, std::size_t site) {
    double electrons = double(light[c]) * double(fall_off_[c / 3]) * share * well;
    if (pattern) electrons = pattern->collect(site, electrons, settings.time);
    if (sensor.noise) electrons = shot.poisson(c, electrons) + sensor.read_noise * read.normal(c);
    if (pattern) electrons += pattern->offset(site);
    return std::uint16_t(
        std::clamp(std::floor(electrons / well * most_ + 0.5), 0.0, double(most_)));
  };
  std::vector<std::uint16_t> counts(has_mosaic() ? fall_off_.size() : light.size());
  parallel_for((fall_off_.size() + kChunk - 1) / kChunk, spec_.threads, [&](std::size_t job) {
    for (std::size_t i = job * kChunk; i < std::min((job + 1) * kChunk, fall_off_.size()); ++i) {
      if (has_mosaic()) {
        const int x = int(i % std::size_t(k.width)), y = int(i / std::size_t(k.width));
        counts[i] = count_one(i * 3 + std::size_t(mosaic_colour(sensor.mosaic, x, y)), i);
      } else {
        for (std::size_t c = i * 3; c < i * 3 + 3; ++c) counts[c] = count_one(c, c);
      }
    }
  });
  return has_mosaic() ? demosaic(sensor.mosaic, k.width, k.height, counts, most_) : counts;
}

std::vector<std::uint8_t> ImageSensor::develop(const std::vector<std::uint16_t>& counts) const {
  std::vector<std::uint8_t> out(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) out[i] = response_[counts[i]];
  if (spec_.sensor.jpeg_quality > 0)
    lose_to_jpeg(out, spec_.intrinsics.width, spec_.intrinsics.height, spec_.sensor.jpeg_quality,
                 spec_.threads);
  return out;
}

double ImageSensor::mean_of(const std::vector<std::uint16_t>& counts) const {
  double sum = 0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < fall_off_.size(); ++i) {
    if (fall_off_[i] <= 0) continue;
    sum += kRed * counts[i * 3] + kGreen * counts[i * 3 + 1] + kBlue * counts[i * 3 + 2];
    ++seen;
  }
  return seen ? sum / double(seen) / most_ : 0;
}

double ImageSensor::mean_of(const std::vector<float>& light, double factor) const {
  double sum = 0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < fall_off_.size(); ++i) {
    if (fall_off_[i] <= 0) continue;
    const auto share = [&](std::size_t c) {
      return std::min(1.0, double(light[i * 3 + c]) * double(fall_off_[i]) * factor);
    };
    sum += kRed * share(0) + kGreen * share(1) + kBlue * share(2);
    ++seen;
  }
  return seen ? sum / double(seen) : 0;
}

}  // namespace rubble
