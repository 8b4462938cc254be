// The steps of a tree that touches nothing.
#include <algorithm>
#include <cmath>

#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/tree_motion.h"
#include "kernel/multibody/springs/tree_springs.h"

namespace rubble {
namespace {

// Largest rotation of a link in a substep of a tree that touches nothing; unit: rad.
constexpr double kTurnPerSubstep = 0.05;
// Above this rotation in a step, trees without springs use Runge-Kutta steps; unit: rad.
constexpr double kFastTurn = 0.02;
constexpr double kTurnPerRungeKutta = 0.25;  // largest rotation of a link in a Runge-Kutta step; unit: rad
constexpr int kMaxSubsteps = 32;  // largest number of substeps in a step
// Springs look ahead by this share of the time: 0.5 would be neutral, 1 damps the most.
constexpr double kSpringSpan = 0.6;

}  // namespace

void TreeMotion::calc_accelerations(const std::vector<double>& at,
                                    std::vector<double>& accelerations) {
  simbody_->set_speeds(at);
  simbody_->calc_forces(gravity_, forces_);
  if (!has_springs_) {
    simbody_->multiply_by_inverse_mass(forces_, accelerations);
    return;
  }
  for (std::size_t i = 1; i < tree_->links.size(); ++i) {
    const TreeLink& link = tree_->links[i];
    double* f = forces_.data() + link.first_u;
    add_spring(i, f);
    for (int k = 0; k < speed_count(link.mobility); ++k) {
      f[k] -= resistance_[i] * state_.u[std::size_t(link.first_u + k)];
    }
  }
  inertia_.factor(*tree_, end_, diagonal_);
  impulses_.assign(tree_->links.size(), {});
  inertia_.solve(impulses_, forces_, changes_);
  calc_speeds(*tree_, end_, changes_, accelerations);
}

void TreeMotion::take_verlet_step(double h) {
  set_diagonal(0.5 * h, kSpringSpan * h);
  const std::size_t count = state_.u.size();
  calc_accelerations(state_.u, first_);
  between_.resize(count);
  for (std::size_t k = 0; k < count; ++k) between_[k] = h * (state_.u[k] + 0.5 * h * first_[k]);
  move_joints(between_);
  for (std::size_t k = 0; k < count; ++k) {
    state_.u[k] += 0.5 * h * first_[k];
    between_[k] = state_.u[k] + 0.5 * h * first_[k];
  }
  simbody_->set_state({state_.q, between_});
  end_ = simbody_->pose();
  set_diagonal(0.5 * h, kSpringSpan * h);
  calc_accelerations(between_, second_);
  for (std::size_t k = 0; k < count; ++k) state_.u[k] += 0.5 * h * second_[k];
}

// The classical method of fourth order, for trees without springs. Quaternions are integrated as
// four numbers.
void TreeMotion::take_runge_kutta_step(double h) {
  const TreeState start = state_;
  TreeState sum = start, at = start;
  constexpr double kShare[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, kAhead[4] = {0.5, 0.5, 1, 0};
  std::vector<double>& rates = second_;
  for (int stage = 0; stage < 4; ++stage) {
    if (stage > 0) {
      simbody_->set_state({normalized_coordinates(at.q), at.u});
      simbody_->pose();
    }
    calc_accelerations(at.u, first_);
    rates.resize(at.q.size());
    for (const TreeLink& link : tree_->links) {
      joint_of(link.mobility)
          .calc_rates(at.q.data() + link.first_q, at.u.data() + link.first_u,
                      rates.data() + link.first_q);
    }
    for (std::size_t k = 0; k < at.q.size(); ++k) {
      sum.q[k] += h * kShare[stage] * rates[k];
      at.q[k] = start.q[k] + h * kAhead[stage] * rates[k];
    }
    for (std::size_t k = 0; k < at.u.size(); ++k) {
      sum.u[k] += h * kShare[stage] * first_[k];
      at.u[k] = start.u[k] + h * kAhead[stage] * first_[k];
    }
  }
  state_ = {normalized_coordinates(sum.q), sum.u};
  simbody_->set_state(state_);
  end_ = simbody_->pose();
}

std::vector<double> TreeMotion::normalized_coordinates(std::vector<double> q) const {
  for (const TreeLink& link : tree_->links) {
    if (coordinate_count(link.mobility) < 4) continue;
    double* x = q.data() + link.first_q;
    const Quat r = normalized(Quat{x[0], x[1], x[2], x[3]});
    x[0] = r.w, x[1] = r.x, x[2] = r.y, x[3] = r.z;
  }
  return q;
}

void TreeMotion::take_free_step(double h, bool fast) {
  Sums wanted = calc_sums(end_, motions_);
  double energy = wanted.energy + tree_->mass * gravity_ * wanted.centre.z;
  if (has_springs_) energy += calc_spring_energy(*tree_, state_.q);
  if (feels_loads_) add_weights(end_, 0.5 * h, external_);
  if (fast) {
    take_runge_kutta_step(h);
  } else {
    take_verlet_step(h);
  }
  if (feels_loads_) add_weights(end_, 0.5 * h, external_);
  calc_motions(*tree_, end_, state_.u, motions_);
  wanted.linear.z -= tree_->mass * gravity_ * h;
  energy -= tree_->mass * gravity_ * calc_sums(end_, motions_).centre.z;
  if (has_springs_) energy -= calc_spring_energy(*tree_, state_.q);
  conserve(wanted, energy, !has_springs_);
}

void TreeMotion::move_freely() {
  const double turn = farthest_turn();
  const bool fast = turn > kFastTurn && !has_springs_;
  const double wanted = std::ceil(turn / (fast ? kTurnPerRungeKutta : kTurnPerSubstep));
  const int substeps = wanted >= kMaxSubsteps ? kMaxSubsteps : std::max(1, int(wanted));
  for (int i = 0; i < substeps; ++i) take_free_step(step_ / substeps, fast);
  end_step();
}

}  // namespace rubble
