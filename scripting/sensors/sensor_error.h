// Errors of a reading: white noise, a bias that stays, one that walks, one that drifts and comes back.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

namespace rubble {

// Standard deviations in the unit of the reading.
struct ErrorFigures {
  double noise = 0;       // white, of a reading
  double bias = 0;        // drawn once
  double walk = 0;        // of the bias after a second: it grows with the square root of time
  double drift = 0;       // of a first-order Gauss-Markov process, which begins in its steady state
  double drift_time = 1;  // its correlation time; unit: s; > 0
};

class SensorError {
 public:
  // No seed: no error.
  SensorError(const ErrorFigures& figures, std::optional<std::uint64_t> seed, std::string_view name, double rate_hz)
      : figures_(figures), on_(seed.has_value()), random_(seed.value_or(0), name), rate_hz_(rate_hz),
        kept_(portable::exp(-std::min(1 / (figures.drift_time * rate_hz), 700.0))) {
    if (!on_) return;
    bias_ = figures.bias * random_.normal();
    drift_ = figures.drift * random_.normal();
  }

  // Of the readings in their order.
  double next() {
    if (!on_) return 0;
    const double error = bias_ + drift_ + figures_.noise * random_.normal();
    bias_ += figures_.walk / std::sqrt(rate_hz_) * random_.normal();
    drift_ = kept_ * drift_ + figures_.drift * std::sqrt(1 - kept_ * kept_) * random_.normal();
    return error;
  }

 private:
  ErrorFigures figures_;
  bool on_;
  RandomStream random_;
  double rate_hz_, kept_;
  double bias_ = 0, drift_ = 0;
};

}  // namespace rubble
