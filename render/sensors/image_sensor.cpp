#include "render/sensors/image_sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/quick_math.h"
#include "render/sensors/bayer.h"
#include "render/sensors/fixed_pattern.h"
#include "render/sensors/jpeg_loss.h"
#include "render/sensors/noise_field.h"

namespace rubble {

namespace {

constexpr std::size_t kChunk = 1 << 15;  // of what is counted, a job
constexpr std::size_t kSitesAtOnce = 256;
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
  std::vector<std::uint16_t> counts(has_mosaic() ? fall_off_.size() : light.size());
  // Of what is counted: where in `light` its light is.
  const auto place_of = [&](std::size_t site) {
    if (!has_mosaic()) return site;
    const int x = int(site % std::size_t(k.width)), y = int(site / std::size_t(k.width));
    return site * 3 + std::size_t(mosaic_colour(sensor.mosaic, x, y));
  };
  const auto count_some = [&](std::size_t first, std::size_t n) {
    std::array<std::uint32_t, kSitesAtOnce> places;
    std::array<double, kSitesAtOnce> electrons, noise;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t place = place_of(first + i);
      places[i] = std::uint32_t(place);
      electrons[i] = double(light[place]) * double(fall_off_[place / 3]) * share * well;
      if (pattern) electrons[i] = pattern->collect(first + i, electrons[i], settings.time);
    }
    if (sensor.noise) {
      shot.poisson(places.data(), electrons.data(), n, electrons.data());
      read.normal(places.data(), n, noise.data());
      for (std::size_t i = 0; i < n; ++i) electrons[i] += sensor.read_noise * noise[i];
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (pattern) electrons[i] += pattern->offset(first + i);
      counts[first + i] = std::uint16_t(std::clamp(electrons[i] / well * most_ + 0.5, 0.0, double(most_)));
    }
  };
  parallel_for((counts.size() + kChunk - 1) / kChunk, spec_.threads, [&](std::size_t job) {
    const std::size_t end = std::min((job + 1) * kChunk, counts.size());
    for (std::size_t first = job * kChunk; first < end; first += kSitesAtOnce)
      count_some(first, std::min(kSitesAtOnce, end - first));
  });
  return has_mosaic() ? demosaic(sensor.mosaic, k.width, k.height, counts, most_) : counts;
}

std::vector<std::uint8_t> ImageSensor::develop(const std::vector<std::uint16_t>& counts) const {
  std::vector<std::uint8_t> out(counts.size());
  parallel_for((counts.size() + kChunk - 1) / kChunk, spec_.threads, [&](std::size_t job) {
    for (std::size_t i = job * kChunk; i < std::min((job + 1) * kChunk, counts.size()); ++i) out[i] = response_[counts[i]];
  });
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
