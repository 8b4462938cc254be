// The motion of a body that was simulated in equal steps, at any time: a link of a robot.
#pragma once

#include <cstdint>
#include <vector>

#include "scripting/trajectory/motion_path.h"

namespace rubble {

// Passes through the pose of every step, bit for bit. In between, position and quaternion are cubic Hermite
// curves with the tangents of central differences (Catmull and Rom 1974): velocity and angular velocity
// are continuous. In free fall by symplectic Euler steps the acceleration is exactly that of gravity.
class SimulatedPath : public MotionPath {
 public:
  // poses: one a step, from the step `first` on, which is at first * step; at least two. step: unit: s; > 0
  SimulatedPath(std::vector<Pose> poses, double step, std::int64_t first = 0);

  double duration() const override;
  Pose at(double t) const override;
  CameraMotion motion_at(double t) const override;
  bool is_simulated() const override { return true; }

 private:
  struct Place {
    std::size_t step = 0;  // the curve from this step to the next
    double share = 0;      // how far along it; range: 0 to 1
  };
  Place find(double t) const;

  std::vector<Pose> poses_;  // neighbouring quaternions less than half a turn apart
  std::vector<Vec3> velocities_;  // at the steps, of one step; unit: m
  std::vector<Quat> turnings_;    // likewise, of the quaternions' components
  double step_;
  double first_;  // step of the first pose
};

}  // namespace rubble
