// Rates in steps of the simulation: what has a rate happens after whole steps.
#pragma once

#include <algorithm>
#include <cstdint>

namespace rubble {

inline constexpr double kUsualRobotStep = 1.0 / 240;  // unit: s

// hz: > 0; step: unit: s
inline std::int64_t steps_between(double hz, double step) {
  return std::max(std::int64_t(1), std::int64_t(1 / (hz * step) + 0.5));
}
// What the rate comes to; unit: Hz
inline double used_rate(double hz, double step) { return 1 / (double(steps_between(hz, step)) * step); }

}  // namespace rubble
