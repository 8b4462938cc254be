// How long a camera exposes, and how much it amplifies: fixed, or following the light with a lag, so
// that a sudden change leaves some frames too bright or too dark.
#pragma once

#include <cmath>
#include <deque>

#include "kernel/base/quick_math.h"
#include "render/scene/camera_spec.h"

namespace rubble {

struct ExposureSettings {
  double time = 0.01;  // unit: s
  double iso = 100;    // speed by ISO 12232
};

// Share of saturation per kcd/m2: ExposureSpec's formula.
double saturation_share(const ExposureSettings& settings, double f_number);

class ExposureControl {
 public:
  explicit ExposureControl(const ExposureSpec& spec);

  ExposureSettings settings() const;
  // Before the first frame: where a camera that has looked at this scene for long would be. mean:
  // of min(1, share of saturation) over the image, as a function of the factor by which the present
  // exposure is multiplied.
  template <typename Mean>
  void settle(const Mean& mean) {
    if (spec_.mode != ExposureMode::automatic) return;
    double low = -24, high = 24;
    for (int i = 0; i < 40; ++i) {
      const double stops = 0.5 * (low + high);
      (mean(quick::exp2(stops)) < goal() ? low : high) = stops;
    }
    exposure_ = clamp(exposure_ + 0.5 * (low + high));
  }
  // After each frame. mean: share of saturation over the image as it was measured, at most 1;
  // elapsed: to the next frame, unit: s.
  void follow(double mean, double elapsed);

 private:
  double goal() const;
  double shortest_time() const;  // unit: s
  double clamp(double exposure) const;

  ExposureSpec spec_;
  double exposure_;             // log2(time * speed)
  std::deque<double> wanted_;   // of the frames whose metering has not arrived yet
};

}  // namespace rubble
