// Speed limits on a path that has times already: it is slowed down where it is too fast, and nowhere
// made faster.
//
// Along the path the speed is bounded by the asked one, by max_speed, by the turn rate, and in bends
// by the square root of (a / curvature); then a pass forwards and one backwards bound its change
// (Bobrow, Dubowsky and Gibson 1985, "Time-optimal control of robotic manipulators along specified
// paths"; here with bounds on the acceleration itself). Half of the square of max_acceleration goes
// to bends and half to braking, so that both together keep it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct SpeedLimits {
  std::optional<double> max_speed;          // unit: m/s; > 0
  std::optional<double> max_acceleration;   // unit: m/s2; > 0
  std::optional<double> max_turn_rate_deg;  // unit: degree/s; > 0
  // Kept by smoothing and, where that is not enough, by slowing down; CameraPath. unit: m/s3; > 0
  std::optional<double> max_jerk{};

  bool any() const { return max_speed || max_acceleration || max_turn_rate_deg || max_jerk; }
  bool scales_time() const { return max_speed || max_acceleration || max_turn_rate_deg; }
};

// When the path was to be where it is, and how fast that time runs.
struct AskedTime {
  double time = 0;    // unit: s
  double rate = 1;    // its first derivative
  double change = 0;  // its second derivative; unit: 1/s
};

class TimeScale {
 public:
  TimeScale() = default;  // leaves every time as it is
  // path: the pose at an asked time from 0 to duration; corners: times where it may change abruptly, ascending; step: of the
  // table; unit: s. at_rest: with a max_acceleration, the path starts from rest and comes to rest.
  TimeScale(const std::function<Pose(double)>& path, const std::vector<double>& corners, double duration, double step,
            const SpeedLimits& limits, bool at_rest = false);

  double duration(double asked) const { return new_.empty() ? asked : new_.back(); }
  // Monotone and C1: cubic between the table's entries (Fritsch and Butland 1984, "A method for
  // constructing local monotone piecewise cubic interpolants").
  AskedTime at(double t) const;
  double when(double asked) const;  // the inverse; unit: s

 private:
  std::vector<double> asked_, new_;  // ascending, of equal length
  std::vector<double> rates_;        // at the entries
};

}  // namespace rubble
