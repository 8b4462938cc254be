// Pose of a tree in world axes, as Simbody computes it from its coordinates. All other files of this folder use it.
// Spatial vectors are about `reference`, a point near the tree, so that no digits are lost far from the world's origin.
#pragma once

#include <vector>

#include "kernel/multibody/spatial.h"
#include "kernel/multibody/tree.h"

namespace rubble {

struct LinkPose {
  double mass = 0;  // 0: immovable; unit: kg
  Vec3 centre;      // of mass, from the reference; unit: m
  Mat3 inertia;     // about the centre of mass, world axes; unit: kg m2

  // Momentum of a motion.
  Spatial momentum(const Spatial& motion) const {
    const Vec3 w = motion.angular();
    const Vec3 p = (motion.linear() + cross(w, centre)) * mass;
    return {inertia * w + cross(centre, p), p};
  }
  Vec3 centre_velocity(const Spatial& motion) const {
    return motion.linear() + cross(motion.angular(), centre);
  }
};

struct TreePose {
  Vec3 reference;               // of a free tree: the root's centre of mass; unit: m
  std::vector<LinkPose> links;  // in the order of Tree::links
  // By speed, of links with a parent: the motion that a unit of the speed gives to the link (a
  // column of Simbody's hinge matrix H), and what a motion of the link against its parent is
  // multiplied by to give the speed.
  std::vector<Spatial> axes, duals;
};

// By link, of the speeds of a tree and back.
void calc_motions(const Tree& tree, const TreePose& pose, const std::vector<double>& u,
                  std::vector<Spatial>& motions);
void calc_speeds(const Tree& tree, const TreePose& pose, const std::vector<Spatial>& motions,
                 std::vector<double>& u);

}  // namespace rubble
