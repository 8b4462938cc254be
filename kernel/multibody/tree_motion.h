// One awake tree during one step.
//
// Forces change the speeds at a fixed position: (M + t (C + s K)) du = t (f - (C + s K) u), springs
// and dampers implicit over the span s. Then the tree moves, and the speeds are carried to the new
// position by the midpoint rule: (J + J')^T / 2 (p(u') - p(u)) = 0, where p are the links' momenta.
// It holds the centrifugal and gyroscopic terms, keeps momentum, and its energy error is of third
// order in the step; what it would gain is taken away again.
//
// A tree that touches nothing takes half the forces before and half after it moves (leapfrog); one
// in contact moves with the substeps of the contact solver, at the Jacobian of the step's start.
#pragma once

#include <vector>

#include "kernel/multibody/tree_dynamics.h"

namespace rubble {

class TreeMotion {
 public:
  // `tree` and `bodies` must stay where they are until the step's end; the rests of the tree's
  // springs creep. gravity: downwards, unit: m/s2; step: unit: s.
  void begin(Tree& tree, const std::vector<Body>& bodies, TreeState state, double gravity,
             double step);

  // Whether a joint may reach a stop in this step.
  bool near_stop() const;
  double stop_margin(const TreeLink& link) const;

  // The whole step without contacts.
  void move_freely();

  // With contacts: begin, then for each substep add_forces(), impulses on `u`, move(); then pushes
  // on `moved` and finish().
  void begin_substeps(double h);
  void add_forces();
  void move();
  // The part of a slow speed that pushes undo is lost.
  void drop_opposed_speed(double step, double slow);
  void finish();

  // Row of a unit impulse at a link, by speed: J for a torque about the link's centre of mass and
  // a force there, and M^-1 J^T of the same.
  void add_row(int link, const Vec3& torque, const Vec3& force, double* jacobian, double* response);
  void solve(double* x) const { implicit_.solve(x); }
  // What a contact did to a link in this step; unit: N m s, N s.
  void add_impulse(int link, const Vec3& torque, const Vec3& force);

  // After the step: notes what each joint carried on average, where one may break.
  void note_loads();
  // By link, moment about its joint; empty where none may break. unit: N m, N
  const std::vector<Spatial>& loads() const { return loads_; }
  // By link, at the end: pose and speeds.
  const TreePose& pose() const { return end_; }
  Vec3 linear_velocity(std::size_t link) const {
    return calc_com_velocity(end_, link, motions_[link]);
  }
  Vec3 angular_velocity(std::size_t link) const { return motions_[link].angular; }
  const std::vector<Spatial>& motions() const { return motions_; }
  const Tree& tree() const { return *tree_; }
  const TreeState& state() const { return state_; }
  int size() const { return tree_->u_count; }
  // Makes all speeds at the end slower.
  void slow_down(double factor);

  std::vector<double> moved;        // displacement of the step, by speed
  std::vector<double> before_push;  // the same without what push_apart() adds
  bool touching = false;            // something else, in this step
  double* u() { return state_.u.data(); }

 private:
  void factor(const TreePose& pose, double time, double span);
  void set_weights(const TreePose& pose);
  void kick(double time);
  // What the tree moves in `time` without forces, to second order: into `moved`.
  void calc_drift(const TreePose& pose, double time);
  void carry_speeds(const TreePose& from, const TreePose& to);
  void limit_energy(double energy, const TreePose& pose);
  double calc_energy(const TreePose& pose);
  int count_substeps() const;

  Tree* tree_ = nullptr;
  const std::vector<Body>* bodies_ = nullptr;
  TreeState state_;
  double gravity_ = 0, step_ = 0, substep_ = 0;
  TreePose start_, end_;
  SymmetricMatrix mass_, stiff_mass_;
  Cholesky plain_, implicit_;  // of M; of M with springs
  bool has_springs_ = false;
  std::vector<Spatial> weights_;            // by link
  std::vector<double> generalized_weights_;
  std::vector<double> resistance_;  // by link: C + s K where it is not yielding
  std::vector<Spatial> start_momenta_, external_, loads_;
  std::vector<std::vector<double>> responses_;  // by link: M^-1 J^T of six unit impulses; or empty
  // Scratch.
  std::vector<Spatial> motions_, momenta_, forces_;
  std::vector<double> generalized_, other_;
};

}  // namespace rubble
