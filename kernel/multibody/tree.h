// A tree of bodies joined by mobilizers, as the kernel keeps it between two steps. SimbodyTree holds
// its coordinates q and speeds u and computes with them; here is how they are to be read, and what
// the joints remember.
//
// Coordinates are Simbody's. A link hangs on its parent by a joint with a frame on either side:
//   world_from_link = world_from_parent * parent_from_joint * joint(q) * link_from_joint^-1
// where the frames of links sit in their centres of mass.
//   free    q: quaternion w x y z, position;  u: angular, linear velocity in the world (roots only)
//   fixed   none: an immovable root
//   weld    none
//   hinge   q: angle about Z;     u: its rate
//   slider  q: travel along X;    u: its rate
//   ball    q: quaternion;        u: angular velocity in the joint's frame on the parent
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/model/assembly.h"
#include "kernel/multibody/spatial.h"

namespace rubble {

enum class Mobility : std::int32_t { free, fixed, weld, hinge, slider, ball };
inline constexpr int kMobilities = 6;  // how many there are

// No default: a kind that is missing does not compile.
constexpr int coordinate_count(Mobility m) {
  switch (m) {
    case Mobility::free:
      return 7;
    case Mobility::ball:
      return 4;
    case Mobility::hinge:
    case Mobility::slider:
      return 1;
    case Mobility::fixed:
    case Mobility::weld:
      return 0;
  }
  return 0;
}
constexpr int speed_count(Mobility m) {
  switch (m) {
    case Mobility::free:
      return 6;
    case Mobility::ball:
      return 3;
    case Mobility::hinge:
    case Mobility::slider:
      return 1;
    case Mobility::fixed:
    case Mobility::weld:
      return 0;
  }
  return 0;
}

// What drives a joint of one speed: see RobotMotor.
struct TreeMotor {
  bool on = false;                             // false: nothing drives the joint
  double stiffness = 0, damping = 0;           // of the present mode
  double position = 0, speed = 0, torque = 0;  // targets; unit: rad, rad/s, N m; slider m, m/s, N
  double effort = 0, speed_limit = 0;          // bounds: of the torque, and of the speed to which the motor drives
  double impulse = 0;                          // of the last substep; unit: N m s, slider N s
  double mean = 0;                             // of the last step; unit: N m, slider N
  double work = 0;                             // so far; unit: J
};

// What a link of a robot feels, mean of a step, in the world. Contacts: the moment about its centre of
// mass; the joint: what it gives to the link, the moment about the joint. unit: N, N m
struct LinkLoads {
  Vec3 contact_force, contact_moment, joint_force, joint_moment;  // as above
};

struct TreeLink {
  std::int32_t body = 0;                    // index of the piece
  std::int32_t parent = -1;                 // index of a link before this one; -1: the root
  Mobility mobility = Mobility::free;       // of the joint to the parent; of a root: free or fixed
  std::int32_t first_q = 0, first_u = 0;    // where the tree's q and u hold its own
  Pose parent_from_joint, link_from_joint;  // unit: m
  // The joint to the parent: see JointType.
  double stiffness = 0, damping = 0, friction = 0, yield = kNever;
  double break_force = kNever, break_torque = kNever;  // unit: N, N m
  double lower = -kNever, upper = kNever;              // of the coordinate; unit: rad, slider m
  // A hinge of an inflated tube: its spring wrinkles from this moment on (tree_springs.h), which it shares
  // with another hinge of equal stiffness that bends the other way; -1: none. unit: N m
  double wrinkling = kNever;
  std::int32_t wrinkles_with = -1;
  bool collide = false;                                // true: it touches its parent as other pieces do
  // Where the spring is at rest: it creeps.
  double rest = 0;     // hinge, slider; unit: rad, m
  Quat rest_rotation;  // ball
  // Of dry friction on the joint's speeds, in the last substep; unit: N m s, slider N s.
  Vec3 friction_impulse;
  // Motion of the centre of mass, mirrored after each step.
  Vec3 linear, angular;  // unit: m/s, rad/s
  // Of robots.
  TreeMotor motor;
  Vec3 belt_axis;         // see RobotLink; zero: no belt
  double belt_speed = 0;  // unit: m/s
  Vec3 eversion_axis;     // see RobotLink; belt_speed is then that of growth
  LinkLoads loads;        // of the last step
};

// A joint between two links that hang together without it: it closes a loop, and is held by rows in
// the contact solver's sweeps.
struct TreeLoop {
  std::int32_t link_a = 0, link_b = 0;                 // indices into Tree::links
  Mobility mobility = Mobility::ball;                  // what the joint leaves free
  Pose a_from_joint, b_from_joint;                     // unit: m
  double break_force = kNever, break_torque = kNever;  // unit: N, N m
  bool collide = false;                                // as TreeLink::collide
  // Along and about the axes of the joint in A, of the last substep; unit: N s, N m s.
  Vec3 force_impulse, torque_impulse;
  bool broken = false;  // in this step
};

struct Tree {
  std::vector<TreeLink> links;            // parents before children; empty: the tree has come apart
  std::vector<TreeLoop> loops;            // none in a tree without loops
  std::int32_t q_count = 0, u_count = 0;  // of all links
  double mass = 0;                        // of what moves; unit: kg
  Pose root;                              // world_from_com of a fixed root
  bool driven = false;                    // a robot: never sleeps, and feels loads
  bool tube = false;  // grows: links up to two apart are of one fold, and do not touch each other

  bool has_fixed_root() const { return !links.empty() && links[0].mobility == Mobility::fixed; }
};

// Coordinates and speeds of one tree.
struct TreeState {
  std::vector<double> q, u;  // as long as the tree's q_count and u_count
};

// Numbers the coordinates of the links.
void number_coordinates(Tree& tree);

// Pose of a tree in world axes, as Simbody computes it from its coordinates. All other files of this folder use it.
// Spatial vectors are about `reference`, a point near the tree, so that no digits are lost far from the world's origin.

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
