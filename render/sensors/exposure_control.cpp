#include "render/sensors/exposure_control.h"

#include <algorithm>

#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr double kMiddleGrey = 0.18;
constexpr double kShortest = 1e-5;   // if the longest is not shorter; unit: s
constexpr double kDarkest = 1e-4;    // a mean that is still told from none
constexpr double kMostStops = 3;     // that one frame asks for

}  // namespace

double saturation_share(const ExposureSettings& settings, double f_number) {
  return 1000 * 0.65 * settings.time * settings.iso / (78 * f_number * f_number);
}

ExposureControl::ExposureControl(const ExposureSpec& spec)
    : spec_(spec), exposure_(quick::log2(spec.time * spec.iso)) {}

double ExposureControl::shortest_time() const { return std::min(kShortest, spec_.longest_time); }

ExposureSettings ExposureControl::settings() const {
  if (spec_.mode != ExposureMode::automatic) return {spec_.time, spec_.iso};
  const double product = quick::exp2(exposure_);
  const double time = std::clamp(product / spec_.iso, shortest_time(), spec_.longest_time);
  return {time, std::clamp(product / time, spec_.iso, std::max(spec_.iso, spec_.highest_iso))};
}

double ExposureControl::goal() const {
  return std::min(0.9, kMiddleGrey * quick::exp2(spec_.compensation));
}

double ExposureControl::clamp(double exposure) const {
  return std::clamp(exposure, quick::log2(shortest_time() * spec_.iso),
                    quick::log2(spec_.longest_time * std::max(spec_.iso, spec_.highest_iso)));
}

void ExposureControl::follow(double mean, double elapsed) {
  if (spec_.mode != ExposureMode::automatic) return;
  const double stops = quick::log2(goal() / std::max(mean, kDarkest));
  wanted_.push_back(exposure_ + std::clamp(stops, -kMostStops, kMostStops));
  if (int(wanted_.size()) <= spec_.delay) return;
  const double share = spec_.time_constant > 0 ? 1 - quick::exp(-elapsed / spec_.time_constant) : 1;
  exposure_ = clamp(exposure_ + share * (wanted_.front() - exposure_));
  wanted_.pop_front();
}

}  // namespace rubble
