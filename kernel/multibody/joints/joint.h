// The table of joints: one file for each joint. A new joint needs a file here, a case in joint_table.cpp, and names where
// it is written and read. The compiler reports switches without it.
#pragma once

#include "kernel/model/assembly.h"
#include "kernel/multibody/tree.h"

namespace rubble {

struct MobilizerPlace;  // mobilizer.h: it knows Simbody

// A stop that the joint is near: pushes only along `direction` (of the link's speeds).
struct JointStop {
  double gap = 0;            // how far away; unit: rad, m
  double direction[3] = {};  // unit length, in the joint's frame
};

class Joint {
 public:
  virtual ~Joint() = default;

#ifndef RUBBLE_WITHOUT_SIMBODY
  // Adds it to a Simbody system.
  virtual void mobilize(MobilizerPlace& place) const = 0;
#endif

  // Moves the joint's own coordinates, by a displacement in the units of its speeds times time.
  virtual void move(const double* displacement, double* q) const;

  // dq/dt at speeds u.
  virtual void calc_rates(const double* q, const double* u, double* rates) const;

  // What a loop of this joint holds: along X, Y, Z of its frame, and about them.
  virtual bool holds_travel(int axis) const = 0;
  virtual bool holds_turn(int axis) const = 0;

  // Figures at scale s; see assembly.h.
  virtual void set_figures(const JointType& type, double s, TreeLink& link) const;

  // Its spring; q and forces are the joint's own.
  virtual void add_spring(const TreeLink& link, const double* q, double* forces) const;
  // What the spring's torque changes by when the joint moves on: its stiffness, or 0 where it
  // yields. u: the joint's own speeds.
  virtual double calc_tangent_stiffness(const TreeLink& link, const double* q,
                                        const double* u) const;
  virtual double calc_spring_energy(const TreeLink& link, const double* q) const;  // unit: J
  // Lets the rest follow where the spring carries more than its yield. Takes energy, never gives.
  virtual void creep(TreeLink& link, const double* q) const;

  // Writes the stops that are nearer than `margin`; returns how many, 2 at most.
  virtual int find_stops(const TreeLink& link, const double* q, double margin,
                         JointStop* stops) const;
};

const Joint& joint_of(Mobility mobility);
Mobility mobility_of(JointKind kind);
JointKind kind_of(Mobility mobility);  // of roots: weld

// One of each, from their files.
const Joint& free_root();
const Joint& fixed_root();
const Joint& weld_joint();
const Joint& hinge_joint();
const Joint& slider_joint();
const Joint& ball_joint();

}  // namespace rubble
