#include "kernel/settling/ground_motion.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

constexpr int kSines = 20;        // enough sine waves that no beat is noticeable; unit: 1
constexpr double kRise = 0.15;    // begin of the strong part, as a share of the duration; unit: 1
constexpr double kFade = 0.6;     // end of the strong part, as a share of the duration; unit: 1
constexpr double kFadeRate = 4;   // exponential decay rate after the strong part; unit: 1

double envelope(double share) {
  if (share < kRise) return share * share / (kRise * kRise);
  if (share < kFade) return 1;
  return portable::exp(-kFadeRate * (share - kFade) / (1 - kFade));
}

}  // namespace

GroundMotion::GroundMotion(const CollapseCause& cause, std::uint64_t seed, double step) {
  const portable::SinCos direction = portable::sincos(cause.shake_direction_deg * portable::kPi / 180);
  direction_ = {direction.cos, direction.sin, 0};
  if (!(cause.shake > 0)) return;
  cause.accelerogram.empty() ? draw(cause, seed, step) : read(cause, step);
  double most = 0;
  for (const double sample : samples_) most = std::max(most, std::abs(sample));
  for (double& sample : samples_) sample *= most > 0 ? cause.shake / most : 0;
}

void GroundMotion::read(const CollapseCause& cause, double step) {
  const std::vector<double>& a = cause.accelerogram;
  for (double time = 0; time < cause.shaking_time(); time = double(samples_.size()) * step) {
    const double place = time / cause.accelerogram_step;
    const auto before = std::min(std::size_t(place), a.size() - 1);
    const double share = place - double(before), next = before + 1 < a.size() ? a[before + 1] : 0;
    samples_.push_back(a[before] + share * (next - a[before]));
  }
}

void GroundMotion::draw(const CollapseCause& cause, std::uint64_t seed, double step) {
  RandomStream random(seed, "ground motion");
  double frequencies[kSines], phases[kSines];
  for (int i = 0; i < kSines; ++i) {
    frequencies[i] = cause.shake_hz * portable::exp(0.4 * random.normal());
    phases[i] = random.uniform(0, 2 * portable::kPi);
  }
  const int count = int(cause.shake_seconds / step);
  for (int n = 0; n < count; ++n) {
    double sum = 0;
    for (int i = 0; i < kSines; ++i) {
      sum += portable::sin(2 * portable::kPi * frequencies[i] * n * step + phases[i]);
    }
    samples_.push_back(sum * envelope(double(n) / count));
  }
}

Vec3 GroundMotion::at(std::int64_t step) const {
  return over(step) ? Vec3{} : direction_ * samples_[std::size_t(step)];
}

}  // namespace rubble
