// Kinematics and inertia of a tree in world axes.
//
// Motions, momenta and forces are spatial vectors about one reference point (Featherstone, Rigid
// Body Dynamics Algorithms, 2008): a motion is the angular velocity and the velocity of the
// material point at the reference; a momentum or a force is the moment about the reference and the
// linear part. The reference is a point near the tree, so that no digits are lost far from the
// world's origin.
#pragma once

#include <vector>

#include "kernel/collision/body.h"
#include "kernel/multibody/cholesky.h"
#include "kernel/multibody/tree.h"

namespace rubble {

struct Spatial {
  Vec3 angular, linear;

  Spatial& operator+=(const Spatial& s) { return angular += s.angular, linear += s.linear, *this; }
  Spatial& operator-=(const Spatial& s) { return angular -= s.angular, linear -= s.linear, *this; }
  Spatial operator*(double x) const { return {angular * x, linear * x}; }
};
inline double dot(const Spatial& a, const Spatial& b) {
  return dot(a.angular, b.angular) + dot(a.linear, b.linear);
}

// A tree at some coordinates.
struct TreePose {
  Vec3 reference;                    // unit: m
  std::vector<Pose> world_from_com;  // by link
  std::vector<Vec3> joint_position;  // by link: of its joint to the parent; unit: m
  std::vector<Mat3> inertia;         // by link: about its centre of mass, world axes; kg m2
  std::vector<Spatial> axes;         // by speed: the motion that a unit of it gives

  void set(const Tree& tree, const std::vector<Body>& bodies, const std::vector<double>& q,
           const Vec3& reference_point);
};

// M: the kinetic energy is u M u / 2 (composite rigid bodies).
void calc_mass_matrix(const Tree& tree, const std::vector<Body>& bodies, const TreePose& pose,
                      SymmetricMatrix& mass);
// By link, of each: its motion.
void calc_motions(const Tree& tree, const TreePose& pose, const std::vector<double>& u,
                  std::vector<Spatial>& motions);
// Their momenta. Immovable links have none.
void calc_momenta(const Tree& tree, const std::vector<Body>& bodies, const TreePose& pose,
                  const std::vector<Spatial>& motions, std::vector<Spatial>& momenta);
// By link: the force that turns its momentum while the speeds stay as they are (Featherstone's
// recursive Newton-Euler without accelerations and weights).
void calc_bias_forces(const Tree& tree, const std::vector<Body>& bodies, const TreePose& pose,
                      const std::vector<double>& u, const std::vector<Spatial>& motions,
                      const std::vector<Spatial>& momenta, std::vector<Spatial>& forces);
// J^T: generalized forces of a force on each link. On return `forces` holds what each joint
// carries: the sum over its link and all beyond.
void gather(const Tree& tree, const TreePose& pose, std::vector<Spatial>& forces,
            std::vector<double>& generalized);
// Velocity of a link's centre of mass.
inline Vec3 calc_com_velocity(const TreePose& pose, std::size_t link, const Spatial& motion) {
  return motion.linear +
         cross(motion.angular, pose.world_from_com[link].translation - pose.reference);
}

}  // namespace rubble
