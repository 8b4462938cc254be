// How something that carries sensors moves: a path that was asked for, or a motion that was simulated.
#pragma once

#include "kernel/base/math.h"
#include "scripting/trajectory/smooth_path.h"

namespace rubble {

class MotionPath {
 public:
  virtual ~MotionPath() = default;
  virtual double duration() const = 0;  // unit: s
  // t: s after the start; before it and after the end the carrier stands still.
  virtual Pose at(double t) const = 0;
  // t: from 0 to the duration.
  virtual CameraMotion motion_at(double t) const = 0;
  // Whether it comes from the steps of a simulation: accelerations are those of the steps, and an inertial
  // unit takes their mean over the period of its readings.
  virtual bool is_simulated() const { return false; }
};

}  // namespace rubble
