// One awake tree during one step.
//
// A tree that touches nothing takes velocity Verlet steps with Simbody's accelerations:
//   q' = q + h u + h^2/2 a(q, u),   u' = u + h/2 (a(q, u) + a(q', u + h a(q, u)))
// and steps of fourth order (Runge-Kutta) where it turns fast. Springs and dampers are implicit:
// where there are any, M is M + h/2 (C + s K) (see articulated_inertia.h). What the method's error
// takes from the momentum and the energy of a step is given back.
//
// A tree in contact moves with the substeps of the contact solver: forces and impulses change the
// speeds at the position of the step's start. Then the speeds are carried to where the tree has
// gone, by Simbody's Coriolis, centrifugal and gyroscopic forces at both ends.
#pragma once

#include <vector>

#include "kernel/multibody/link_motions.h"
#include "kernel/multibody/simbody_trees.h"

namespace rubble {

class TreeMotion {
 public:
  // `tree` and `simbody`, which has its state, must stay where they are until the step's end; the
  // rests of the tree's springs creep. gravity: downwards, unit: m/s2; step: unit: s.
  void begin(Tree& tree, SimbodyTree& simbody, double gravity, double step);

  // Whether a joint may reach a stop in this step.
  bool near_stop() const;
  // Whether rows of its own hold it: friction in joints, or loops.
  bool has_rows() const;
  double stop_margin(const TreeLink& link) const;

  // The whole step without contacts.
  void move_freely();

  // With contacts: begin_substeps(), then for each substep push() and twist_joint() for what
  // impulses it starts with, add_forces(), impulses on `speeds`, move(); then pushes on `moved` and
  // finish().
  void begin_substeps(double h);
  void push(std::int32_t link, const Spatial& impulse) {
    impulses_[std::size_t(link)] += impulse;
  }
  void add_forces();
  void move();
  void begin_pushes();
  void finish();
  // Where nothing has acted on the tree in the substeps: back to the step's start, for
  // move_freely().
  void begin_again();

  LinkMotions speeds;  // of this substep; about pose().reference
  LinkMotions moved;   // displacement of the step

  const ArticulatedInertia& inertia() const { return inertia_; }
  const TreePose& pose() const { return start_; }  // of the step's start
  const std::vector<double>& q() const { return state_.q; }
  Tree& tree() const { return *tree_; }
  double step() const { return step_; }

  // What a contact did to a link in this step, about pose().reference; unit: N m s, N s.
  void note_impulse(std::int32_t link, const Spatial& impulse, bool by_contact) {
    external_[std::size_t(link)] += impulse;
    if (by_contact) contacts_[std::size_t(link)] += impulse;
  }
  bool feels_loads() const { return feels_loads_; }
  // After the step: notes what each joint carried on average, of robots and where one may break; and what
  // the links of robots feel.
  void note_loads();
  // By link, moment about its joint; empty where nothing feels them. unit: N m, N
  const std::vector<Spatial>& loads() const { return loads_; }

  // By link, at the end.
  const std::vector<Pose>& world_from_links() const { return world_from_links_; }
  Vec3 linear_velocity(std::size_t link) const {
    return end_.links[link].centre_velocity(motions_[link]);
  }
  Vec3 angular_velocity(std::size_t link) const { return motions_[link].angular(); }

  bool touching = false;  // something else, in this step
  bool impelled = false;  // by a contact, a stop or a loop, in this step

 private:
  // Momentum about the centre of mass, and the kinetic energy.
  struct Sums {
    Vec3 centre, linear, angular;  // from the world's origin; unit: m, kg m/s, kg m2/s
    double energy = 0;             // unit: J
  };
  Sums calc_sums(const TreePose& pose, const std::vector<Spatial>& motions) const;
  void add_spring(std::size_t link, double* forces) const;
  // By speed; `at`: the speeds that motion's forces are taken at.
  void calc_accelerations(const std::vector<double>& at, std::vector<double>& accelerations);
  void add_weights(const TreePose& pose, double time, std::vector<Spatial>& to) const;
  void set_diagonal(double time, double span);
  void take_free_step(double h, bool fast);
  void take_verlet_step(double h);
  void take_runge_kutta_step(double h);
  std::vector<double> normalized_coordinates(std::vector<double> q) const;
  void carry_speeds();
  double calc_missed_work() const;
  // coarse: where the tree points at the end is not well known: its momentum is given back as far as the energy reaches.
  void conserve(const Sums& wanted, double energy, bool gain, bool coarse = false);
  double farthest_turn() const;  // of a link in a step; unit: rad
  Spatial calc_rigid_motion(const Mat3& inverse_inertia, const Vec3& centre, const Vec3& linear,
                            const Vec3& angular) const;
  void move_joints(const std::vector<double>& displacement);
  void end_step();
  void note_link_loads();
  void note_work();

  Tree* tree_ = nullptr;
  SimbodyTree* simbody_ = nullptr;
  TreeState state_, start_state_;
  std::vector<TreeLink> start_links_;  // of trees with springs: the rests creep
  double gravity_ = 0, step_ = 0, substep_ = 0;
  bool has_springs_ = false, feels_loads_ = false;
  TreePose start_, end_;
  std::vector<Spatial> motions_;  // at the end, or where it is now
  ArticulatedInertia inertia_;
  std::vector<double> diagonal_;    // by link: of a time, C + s K where it is not yielding
  std::vector<double> resistance_;  // the same, without the time
  std::vector<Spatial> start_momenta_, external_, contacts_, loads_;
  std::vector<Spatial> impulses_, before_push_;
  std::vector<Pose> world_from_links_;
  // Scratch.
  std::vector<Spatial> changes_;
  std::vector<double> forces_, first_, second_, between_;
};

}  // namespace rubble
