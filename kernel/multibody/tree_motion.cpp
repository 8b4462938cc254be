#include "kernel/multibody/tree_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/multibody/tree_joint.h"

namespace rubble {
namespace {

// A free tree takes shorter steps when a link would turn by more than this in one; unit: rad.
constexpr double kTurnPerSubstep = 0.1;
constexpr int kMaxSubsteps = 16;
// Springs look ahead by this share of the time: 0.5 would be neutral, 1 damps the most.
constexpr double kSpringSpan = 0.6;
constexpr int kCarryRounds = 3;
constexpr double kStopMargin = 0.02;  // unit: rad, m

}  // namespace

void TreeMotion::begin(Tree& tree, const std::vector<Body>& bodies, TreeState state, double gravity,
                       double step) {
  tree_ = &tree;
  bodies_ = &bodies;
  state_ = std::move(state);
  gravity_ = gravity;
  step_ = step;
  has_springs_ = false;
  for (const TreeLink& link : tree.links) {
    has_springs_ = has_springs_ || link.stiffness > 0 || link.damping > 0;
  }
  const std::int32_t root = tree.links[0].body;
  start_.set(tree, bodies, state_.q, bodies[std::size_t(root)].world_from_com.translation);
  calc_motions(tree, start_, state_.u, motions_);
  calc_momenta(tree, bodies, start_, motions_, start_momenta_);
  external_.assign(tree.links.size(), {});
  responses_.assign(tree.links.size(), {});
  moved.assign(std::size_t(tree.u_count), 0);
}

double TreeMotion::stop_margin(const TreeLink& link) const {
  double rate = 0;
  for (int k = 0; k < speed_count(link.mobility); ++k) {
    rate = std::max(rate, std::abs(state_.u[std::size_t(link.first_u + k)]));
  }
  return kStopMargin + 2 * step_ * rate;
}

bool TreeMotion::near_stop() const {
  for (const TreeLink& link : tree_->links) {
    JointStop stops[2];
    if (find_stops(link, state_.q.data(), stop_margin(link), stops) > 0) return true;
  }
  return false;
}

void TreeMotion::factor(const TreePose& pose, double time, double span) {
  calc_mass_matrix(*tree_, *bodies_, pose, mass_);
  resistance_.assign(tree_->links.size(), 0);
  plain_.factor(mass_);
  if (!has_springs_) {
    implicit_ = plain_;
    return;
  }
  stiff_mass_ = mass_;
  for (std::size_t i = 0; i < tree_->links.size(); ++i) {
    const TreeLink& link = tree_->links[i];
    if (speed_count(link.mobility) == 0 || link.parent < 0) continue;
    resistance_[i] =
        link.damping + span * calc_tangent_stiffness(link, state_.q.data(), state_.u.data());
    for (int k = link.first_u; k < link.first_u + speed_count(link.mobility); ++k) {
      stiff_mass_.at(k, k) += time * resistance_[i];
    }
  }
  implicit_.factor(stiff_mass_);
}

void TreeMotion::set_weights(const TreePose& pose) {
  weights_.assign(tree_->links.size(), {});
  for (std::size_t i = 0; i < tree_->links.size(); ++i) {
    if (tree_->links[i].mobility == Mobility::fixed) continue;
    const Vec3 weight{0, 0, -gravity_ * (*bodies_)[std::size_t(tree_->links[i].body)].mass};
    const Vec3 arm = pose.world_from_com[i].translation - pose.reference;
    weights_[i] = {cross(arm, weight), weight};
  }
  forces_ = weights_;
  gather(*tree_, pose, forces_, generalized_weights_);
}

// The forces of `time` at a fixed position.
void TreeMotion::kick(double time) {
  for (std::size_t i = 0; i < weights_.size(); ++i) external_[i] += weights_[i] * time;
  generalized_ = generalized_weights_;
  for (std::size_t i = 0; i < tree_->links.size(); ++i) {
    const TreeLink& link = tree_->links[i];
    if (link.parent < 0) continue;
    add_spring(link, state_.q.data(), generalized_.data());
    for (int k = link.first_u; k < link.first_u + speed_count(link.mobility); ++k) {
      generalized_[std::size_t(k)] -= resistance_[i] * state_.u[std::size_t(k)];
    }
  }
  implicit_.solve(generalized_.data());
  for (std::size_t k = 0; k < state_.u.size(); ++k) state_.u[k] += time * generalized_[k];
}

double TreeMotion::calc_energy(const TreePose& pose) {
  calc_motions(*tree_, pose, state_.u, motions_);
  calc_momenta(*tree_, *bodies_, pose, motions_, momenta_);
  double twice = 0;
  for (std::size_t i = 0; i < motions_.size(); ++i) twice += dot(motions_[i], momenta_[i]);
  return 0.5 * twice;
}

// Slows the tree down to an energy it may have. A free tree keeps the speed of its centre of mass.
void TreeMotion::limit_energy(double energy, const TreePose& pose) {
  const double now = calc_energy(pose);
  if (now <= energy) return;
  double common = 0;
  Vec3 drift;
  const bool is_free = tree_->links[0].mobility == Mobility::free;
  if (is_free) {
    for (const Spatial& momentum : momenta_) drift += momentum.linear;
    drift *= 1 / tree_->mass;
    common = 0.5 * tree_->mass * dot(drift, drift);
  }
  const double left = energy - common;
  const double share =
      left > 0 && now > common ? std::sqrt(std::min(1.0, left / (now - common))) : 0;
  for (int i = 0; is_free && i < 3; ++i) state_.u[std::size_t(3 + i)] -= drift[i];
  for (double& speed : state_.u) speed *= share;
  for (int i = 0; is_free && i < 3; ++i) state_.u[std::size_t(3 + i)] += drift[i];
}

void TreeMotion::calc_drift(const TreePose& pose, double time) {
  calc_motions(*tree_, pose, state_.u, motions_);
  calc_momenta(*tree_, *bodies_, pose, motions_, momenta_);
  calc_bias_forces(*tree_, *bodies_, pose, state_.u, motions_, momenta_, forces_);
  gather(*tree_, pose, forces_, generalized_);
  plain_.solve(generalized_.data());
  for (std::size_t k = 0; k < moved.size(); ++k) {
    moved[k] = time * (state_.u[k] - 0.5 * time * generalized_[k]);
  }
}

// The speeds at one position to the speeds at another, whose matrix is factored.
void TreeMotion::carry_speeds(const TreePose& from, const TreePose& to) {
  const double energy = calc_energy(from);
  const std::vector<Spatial> before = momenta_;
  for (int round = 0; round < kCarryRounds; ++round) {
    calc_motions(*tree_, to, state_.u, motions_);
    calc_momenta(*tree_, *bodies_, to, motions_, momenta_);
    for (std::size_t i = 0; i < momenta_.size(); ++i) momenta_[i] -= before[i];
    forces_ = momenta_;
    gather(*tree_, from, forces_, generalized_);
    forces_ = momenta_;
    gather(*tree_, to, forces_, other_);
    for (std::size_t k = 0; k < other_.size(); ++k) {
      generalized_[k] = 0.5 * (generalized_[k] + other_[k]);
    }
    plain_.solve(generalized_.data());
    for (std::size_t k = 0; k < other_.size(); ++k) state_.u[k] -= generalized_[k];
  }
  limit_energy(energy, to);
}

int TreeMotion::count_substeps() const {
  double fastest = 0;
  for (const Spatial& motion : motions_) fastest = std::max(fastest, norm(motion.angular));
  const double wanted = std::ceil(fastest * step_ / kTurnPerSubstep);
  return wanted >= kMaxSubsteps ? kMaxSubsteps : std::max(1, int(wanted));
}

void TreeMotion::move_freely() {
  const int substeps = count_substeps();
  const double h = step_ / substeps;
  const double span = kSpringSpan * h;
  end_ = start_;
  TreePose from;
  factor(end_, 0.5 * h, span);
  set_weights(end_);
  for (int i = 0; i < substeps; ++i) {
    kick(0.5 * h);
    calc_drift(end_, h);
    for (TreeLink& link : tree_->links) {
      move_joint(link, moved.data(), state_.q.data());
      creep(link, state_.q.data());
    }
    std::swap(from, end_);
    end_.set(*tree_, *bodies_, state_.q, from.reference);
    factor(end_, 0.5 * h, span);
    carry_speeds(from, end_);
    set_weights(end_);
    kick(0.5 * h);
  }
  calc_motions(*tree_, end_, state_.u, motions_);
}

void TreeMotion::begin_substeps(double h) {
  substep_ = h;
  factor(start_, h, h);
  set_weights(start_);
}

void TreeMotion::add_forces() { kick(substep_); }

void TreeMotion::move() {
  generalized_ = state_.u;
  for (double& d : generalized_) d *= substep_;
  for (std::size_t k = 0; k < moved.size(); ++k) moved[k] += generalized_[k];
  for (TreeLink& link : tree_->links) {
    move_joint(link, generalized_.data(), state_.q.data());
    creep(link, state_.q.data());
  }
}

void TreeMotion::drop_opposed_speed(double step, double slow) {
  // u.M.u and u.M.push
  double length2 = 0, along = 0;
  for (int i = 0; i < size(); ++i) {
    for (int j = 0; j < size(); ++j) {
      const double m = i >= j ? mass_.at(i, j) : mass_.at(j, i);
      const std::size_t a = std::size_t(i), b = std::size_t(j);
      length2 += m * state_.u[a] * state_.u[b];
      along += m * state_.u[a] * (moved[b] - before_push[b]);
    }
  }
  if (along >= 0 || length2 > slow * slow * tree_->mass) return;
  const double keep = std::max(0.0, 1 + along / (step * length2));
  for (double& speed : state_.u) speed *= keep;
}

void TreeMotion::finish() {
  for (std::size_t k = 0; k < moved.size(); ++k) generalized_[k] = moved[k] - before_push[k];
  for (TreeLink& link : tree_->links) {
    move_joint(link, generalized_.data(), state_.q.data());
    creep(link, state_.q.data());
  }
  end_.set(*tree_, *bodies_, state_.q, start_.reference);
  factor(end_, 0, 0);
  carry_speeds(start_, end_);
  calc_motions(*tree_, end_, state_.u, motions_);
}

void TreeMotion::slow_down(double share) {
  for (double& speed : state_.u) speed *= share;
  for (Spatial& motion : motions_) motion = motion * share;
}

void TreeMotion::add_row(int link, const Vec3& torque, const Vec3& force, double* jacobian,
                         double* response) {
  const std::size_t n = state_.u.size();
  std::vector<double>& columns = responses_[std::size_t(link)];
  const Vec3 arm = start_.world_from_com[std::size_t(link)].translation - start_.reference;
  const auto each_axis = [&](auto&& visit) {
    for (std::int32_t up = link; up >= 0; up = tree_->links[std::size_t(up)].parent) {
      const TreeLink& l = tree_->links[std::size_t(up)];
      for (int k = l.first_u; k < l.first_u + speed_count(l.mobility); ++k) {
        const Spatial& axis = start_.axes[std::size_t(k)];
        visit(std::size_t(k), axis.angular, axis.linear + cross(axis.angular, arm));
      }
    }
  };
  if (columns.empty()) {
    columns.assign(6 * n, 0);
    each_axis([&](std::size_t k, const Vec3& angular, const Vec3& linear) {
      for (int i = 0; i < 3; ++i) {
        columns[std::size_t(i) * n + k] = angular[i];
        columns[std::size_t(3 + i) * n + k] = linear[i];
      }
    });
    for (std::size_t i = 0; i < 6; ++i) implicit_.solve(columns.data() + i * n);
  }
  each_axis([&](std::size_t k, const Vec3& angular, const Vec3& linear) {
    jacobian[k] += dot(angular, torque) + dot(linear, force);
  });
  const double unit[6] = {torque.x, torque.y, torque.z, force.x, force.y, force.z};
  for (std::size_t i = 0; i < 6; ++i) {
    const double* column = columns.data() + i * n;
    for (std::size_t k = 0; k < n; ++k) response[k] += column[k] * unit[i];
  }
}

void TreeMotion::add_impulse(int link, const Vec3& torque, const Vec3& force) {
  const Vec3 arm = start_.world_from_com[std::size_t(link)].translation - start_.reference;
  external_[std::size_t(link)] += {torque + cross(arm, force), force};
}

// The change of momentum of all that hangs on a joint, less what others did to it.
void TreeMotion::note_loads() {
  loads_.clear();
  bool any = false;
  for (const TreeLink& link : tree_->links) {
    any = any || link.break_force < kNever || link.break_torque < kNever;
  }
  if (!any) return;
  calc_momenta(*tree_, *bodies_, end_, motions_, loads_);
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    loads_[i] -= start_momenta_[i];
    loads_[i] -= external_[i];
  }
  gather(*tree_, end_, loads_, generalized_);
  const double per_step = 1 / step_;
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const Vec3 arm = end_.joint_position[i] - end_.reference;
    loads_[i] = {(loads_[i].angular - cross(arm, loads_[i].linear)) * per_step,
                 loads_[i].linear * per_step};
  }
}

}  // namespace rubble
