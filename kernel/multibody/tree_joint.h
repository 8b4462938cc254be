// One joint of a tree: how its coordinates move, its spring, its plastic bend, its stops. All
// without transcendental functions, except for a hinge's angle, which takes those of
// portable_math.
#pragma once

#include "kernel/multibody/tree.h"

namespace rubble {

// The joint's own transform: of its frame on the child in that on the parent; of a free root: of
// the link in the world.
Pose calc_joint_pose(const TreeLink& link, const double* q);

// q after a displacement, in the units of u times time; both of the whole tree.
void move_joint(const TreeLink& link, const double* displacement, double* q);

// Adds the spring's generalized forces to `forces` (of the whole tree, as is q).
void add_spring(const TreeLink& link, const double* q, double* forces);
// What the spring's torque changes by when the joint moves on: its stiffness, or 0 where it yields.
// u: speeds of the whole tree.
double calc_tangent_stiffness(const TreeLink& link, const double* q, const double* u);
// unit: J
double calc_spring_energy(const TreeLink& link, const double* q);
// Lets the rest follow where the spring carries more than its yield. Takes energy, never gives.
void creep(TreeLink& link, const double* q);

// A stop that the joint is near: pushes only along `direction` (of the link's speeds).
struct JointStop {
  double gap = 0;  // how far away; unit: rad, m
  double direction[3] = {};
};
// Writes the stops that are nearer than `margin`; returns how many, 2 at most.
int find_stops(const TreeLink& link, const double* q, double margin, JointStop* stops);

}  // namespace rubble
