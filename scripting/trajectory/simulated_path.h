// The motion of a body that was simulated in equal steps, at any time: a link of a robot.
#pragma once

#include <cstdint>
#include <vector>

#include "scripting/trajectory/smooth_path.h"

namespace rubble {

// Passes through the pose of every step, bit for bit. In between, position and quaternion are cubic Hermite
// curves with the tangents of central differences (Catmull and Rom 1974): velocity and angular velocity
// are continuous. In free fall by symplectic Euler steps the acceleration is exactly that of gravity.
class SimulatedPath : public MotionPath {
 public:
  // Of a body that moves before the first pose. poses: one a step, at least two. step: unit: s; > 0
  SimulatedPath(const std::vector<Pose>& poses, double step);

  // A path that grows, of a body that is at rest at its first pose: needs two poses before it is asked. The curve up to a step is final once the step after the next
  // is there.
  explicit SimulatedPath(double step) : step_(step), from_rest_(true) {}
  void add(Pose pose);  // of the next step
  void clear();
  // Forgets the steps before that one, but for the last three.
  void forget_before(std::int64_t step);

  std::int64_t last_step() const { return first_ + std::int64_t(poses_.size()) - 1; }
  double duration() const override { return step_ * double(last_step()); }
  Pose at(double t) const override;
  CameraMotion motion_at(double t) const override;
  bool is_simulated() const override { return true; }

 private:
  struct Place {
    std::size_t step = 0;  // the curve from this step to the next
    double share = 0;      // how far along it; range: 0 to 1
  };
  Place find(double t) const;
  void set_tangents(std::size_t i);

  std::vector<Pose> poses_;  // neighbouring quaternions less than half a turn apart
  std::vector<Vec3> velocities_;  // at the steps, of one step; unit: m
  std::vector<Quat> turnings_;    // likewise, of the quaternions' components
  double step_;
  bool from_rest_ = false;
  std::int64_t first_ = 0;  // step of the first pose
};

}  // namespace rubble
