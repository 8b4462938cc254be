// Gives back what the methods of a step take from a tree's momentum and energy.
#include <algorithm>
#include <cmath>

#include "kernel/base/inertia.h"
#include "kernel/multibody/tree_motion.h"

namespace rubble {
namespace {

// What is given back of the motion within a tree is at most this share of its energy in a step.
constexpr double kMostGain = 0.1;

Mat3 calc_inertia_about(const TreePose& pose, const Vec3& centre) {
  Mat3 inertia;
  for (const LinkPose& link : pose.links) {
    const Vec3 c = link.centre - centre;
    const double c2 = dot(c, c);  // parallel axes: + m (c.c 1 - c c^T)
    const Mat3 shift{
        {Vec3{c2, 0, 0} - c * c.x, Vec3{0, c2, 0} - c * c.y, Vec3{0, 0, c2} - c * c.z}};
    inertia = inertia + link.inertia + shift * link.mass;
  }
  return inertia;
}

}  // namespace

TreeMotion::Sums TreeMotion::calc_sums(const TreePose& pose,
                                       const std::vector<Spatial>& motions) const {
  Sums sums;
  Vec3 first;
  Spatial momentum;
  double twice = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const LinkPose& link = pose.links[i];
    if (link.mass <= 0) continue;
    const Spatial p = link.momentum(motions[i]);
    momentum += p;
    twice += dot(p, motions[i]);
    first += link.centre * link.mass;
  }
  const Vec3 centre = first * (1 / tree_->mass);
  sums.centre = pose.reference + centre;
  sums.linear = momentum.linear();
  sums.angular = momentum.angular() - cross(centre, momentum.linear());
  sums.energy = 0.5 * twice;
  return sums;
}

// What the momentum of a rigid body with the tree's mass and inertia needs of a motion.
Spatial TreeMotion::calc_rigid_motion(const Mat3& inverse_inertia, const Vec3& centre,
                                      const Vec3& linear, const Vec3& angular) const {
  const Vec3 turning = inverse_inertia * angular;
  return {turning, linear * (1 / tree_->mass) - cross(turning, centre)};
}

// Gives back what a motion without outer forces, gravity apart, has taken from the momentum, and
// what it has taken from the energy or added to it.
double TreeMotion::farthest_turn() const {
  double fastest = 0;
  for (const Spatial& motion : motions_) fastest = std::max(fastest, norm(motion.angular()));
  return fastest * step_;
}

void TreeMotion::conserve(const Sums& wanted, double energy, bool gain, bool coarse) {
  Spatial rigid;
  double shared = 0;  // energy of the motion as one rigid body
  if (!tree_->has_fixed_root()) {
    const Sums now = calc_sums(end_, motions_);
    const Vec3 centre = now.centre - end_.reference;
    const Mat3 inverse = inverse_of(calc_inertia_about(end_, centre));
    const Spatial lost = calc_rigid_motion(inverse, centre, wanted.linear - now.linear,
                                           wanted.angular - now.angular);
    for (Spatial& motion : motions_) motion += lost;
    rigid = calc_rigid_motion(inverse, centre, wanted.linear, wanted.angular);
    const double straight = 0.5 * dot(wanted.linear, wanted.linear) / tree_->mass;
    const double turning = 0.5 * dot(wanted.angular, inverse * wanted.angular);
    shared = straight + turning;
    if (coarse && turning > 0 && shared > energy) {  // as it points now, its momentum would need more energy than there is
      const double kept = std::sqrt(std::max(0.0, energy - straight) / turning);
      for (Spatial& motion : motions_) motion -= calc_rigid_motion(inverse, centre, {}, wanted.angular * (1 - kept));
      rigid = calc_rigid_motion(inverse, centre, wanted.linear, wanted.angular * kept);
      shared = straight + turning * kept * kept;
    }
  }
  const double within = calc_sums(end_, motions_).energy - shared;
  if (within > 0) {
    const double most = gain ? 1 + kMostGain : 1;
    const double share = std::sqrt(std::clamp((energy - shared) / within, 0.0, most));
    for (Spatial& motion : motions_) motion = rigid + (motion - rigid) * share;
  }
  calc_speeds(*tree_, end_, motions_, state_.u);
}

}  // namespace rubble
