// Curves through points and through rotations, each at its time, with their exact derivatives. What
// a trajectory is made of; trajectory.h says which curves they are and where they come from.
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

enum class Interpolation {
  automatic,  // as spline, but with the plan "avoid" the legs of the way that was found
  spline,  // smooth through the waypoints
  // Straight legs at constant speed, turning at constant angular speed (slerp). At the time of a point
  // it is that point, bit for bit, whatever comes after: so a pose that was seen can be kept.
  linear,
};

// The logarithm of a unit quaternion, of the turn below half a round: axis times angle; and back. unit: rad
Vec3 rotation_vector(const Quat& q);
Quat rotation_by(const Vec3& rotation);

// leg: between the times [leg] and [leg + 1]; t: within it; unit: s. The times must increase and
// outlive the curve.
class VectorCurve {
 public:
  VectorCurve(std::vector<Vec3> points, const std::vector<double>& times, Interpolation how);

  Vec3 at(std::size_t leg, double t) const;
  Vec3 rate(std::size_t leg, double t) const;    // first derivative by time
  Vec3 second(std::size_t leg, double t) const;  // second derivative; jumps from leg to leg

 private:
  std::vector<Vec3> points_;
  const std::vector<double>& times_;
  std::vector<Vec3> rates_;  // at the points
  bool linear_;
};

class RotationCurve {
 public:
  RotationCurve(std::vector<Quat> rotations, const std::vector<double>& times, Interpolation how);

  Quat at(std::size_t leg, double t) const;
  Vec3 angular_velocity(std::size_t leg, double t) const;  // in the turning frame; unit: rad/s

 private:
  // On a leg, rotation = start * exp(first b1) * exp(middle b2) * exp(last b3), where b1 to b3 go
  // from 0 to 1 as the sums of cubic Bernstein polynomials.
  struct Bezier {
    Vec3 first, middle, last;  // rotation vectors
  };
  Bezier bezier(std::size_t leg) const;

  std::vector<Quat> rotations_;
  const std::vector<double>& times_;
  std::vector<Vec3> rates_;  // at the points, in the turning frame; unit: rad/s
  bool linear_;
};

}  // namespace rubble
