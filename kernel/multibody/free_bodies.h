// Coordinates q and speeds u of the bodies that no joint holds. What is articulated is Simbody's, see
// simbody_trees.h.
//
// Contact impulses change u, and advance() changes q. The numbers of a sleeping body are never rewritten.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct FreeBody {
  double mass = 1;        // unit: kg
  Mat3 inertia;           // about the centre of mass, in the body; unit: kg m2
  Pose world_from_com;    // frame of the body's axes, in its centre of mass; unit: m
  Vec3 linear_velocity;   // of the centre of mass, in the world; unit: m/s
  Vec3 angular_velocity;  // in the world; unit: rad/s
};

// How a body moves in a step.
struct BodyRates {
  Vec3 linear, angular;              // speeds after the step; unit: m/s, rad/s
  Vec3 extra_linear, extra_angular;  // on top of them in the displacement only
  bool turns_freely = false;         // then this is where it has turned to, whatever the rates
  Quat rotation;                     // world from body, where turns_freely
};

class FreeBodies {
 public:
  static constexpr int kBlockSize = 16;  // pieces that were added together and that one thread moves; unit: 1

  // Adds bodies to fresh blocks, in this order; returns the number of the first one.
  int add(const std::vector<FreeBody>& bodies);
  int size() const { return int(coordinates_.size()); }
  int block_count() const { return int(first_.size()); }
  int block_of_body(int body) const { return block_[std::size_t(body)]; }
  // Number of a block's first body; size() for the block after the last.
  int first_of(int block) const { return block < block_count() ? first_[std::size_t(block)] : size(); }

  // Speeds of one body.
  void set_velocity(int body, const Vec3& linear, const Vec3& angular);
  const Vec3& linear_velocity(int body) const { return speeds_[std::size_t(body)].linear; }
  const Vec3& angular_velocity(int body) const { return speeds_[std::size_t(body)].angular; }

  // Moves a body for the time `dt` by its new speeds u plus the extra displacement rates. Different threads
  // may advance different bodies.
  void advance(int body, const BodyRates& rate, double dt);
  const Pose& world_from_com(int body) const { return coordinates_[std::size_t(body)]; }

  // Puts a body somewhere, bit for bit; used to restore a state.
  void set_pose(int body, const Pose& world_from_com);

 private:
  struct Speeds {
    Vec3 linear, angular;
  };

  std::vector<Pose> coordinates_;     // by body
  std::vector<Speeds> speeds_;        // by body
  std::vector<std::int32_t> block_;   // of each body
  std::vector<std::int32_t> first_;   // body of each block
};

// The rotation of a rigid body on which no torque acts.
struct FreeRotation {
  Quat rotation;  // world from body, after the step
  Vec3 angular;   // angular velocity in the world, after the step; unit: rad/s
};

// Euler's equations over the time dt by the implicit midpoint rule in the body's axes, in substeps of
// at most an eighth of a radian: it keeps the magnitude of the angular momentum and the energy, both
// quadratic, to rounding (Hairer, Lubich and Wanner, Geometric Numerical Integration, IV.2). The orientation
// is then turned by the little that keeps the momentum's direction in the world. Rules that find the
// velocity from the momentum in the world instead spin up thin bars: an angle of 1e-3 rad between bar
// and momentum is many times the bar's speed about its own axis.
// inertia: about the centre of mass, in the body, positive definite; unit: kg m2. angular: in the
// world; unit: rad/s.
FreeRotation rotate_freely(const Quat& world_from_body, const Mat3& inertia, const Vec3& angular,
                           double dt);

}  // namespace rubble
