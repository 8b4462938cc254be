#include "kernel/multibody/tree_motion.h"

#include <algorithm>
#include <cmath>

#include "kernel/multibody/joints/joint.h"

namespace rubble {
namespace {

// A tree that touches nothing takes shorter steps, or those of Runge and Kutta, when a link would
// turn by more than this in one; unit: rad.
constexpr double kTurnPerSubstep = 0.05, kFastTurn = 0.02, kTurnPerRungeKutta = 0.25;
constexpr int kMaxSubsteps = 32;
// Springs look ahead by this share of the time: 0.5 would be neutral, 1 damps the most.
constexpr double kSpringSpan = 0.6;
constexpr double kStopMargin = 0.02;  // unit: rad, m
// What is given back of the motion within a tree is at most this share of its energy in a step.
constexpr double kMostGain = 0.1;

Mat3 inverse_of(const Mat3& m) {
  const Vec3 a = cross(m.rows[1], m.rows[2]), b = cross(m.rows[2], m.rows[0]),
             c = cross(m.rows[0], m.rows[1]);
  return Mat3{{a, b, c}}.transposed() * (1 / dot(m.rows[0], a));
}

}  // namespace

void TreeMotion::begin(Tree& tree, SimbodyTree& simbody, double gravity, double step) {
  tree_ = &tree;
  simbody_ = &simbody;
  state_ = simbody.state();
  gravity_ = gravity;
  step_ = step;
  has_springs_ = may_break_ = false;
  for (const TreeLink& link : tree.links) {
    has_springs_ = has_springs_ || link.stiffness > 0 || link.damping > 0;
    may_break_ = may_break_ || link.break_force < kNever || link.break_torque < kNever;
  }
  start_ = simbody.pose();
  end_ = start_;
  calc_motions(tree, start_, state_.u, motions_);
  start_state_ = state_;
  start_links_.clear();
  if (has_springs_) start_links_ = tree.links;
  impelled = false;
  external_.assign(tree.links.size(), {});
  start_momenta_.clear();
  for (std::size_t i = 0; may_break_ && i < motions_.size(); ++i) {
    start_momenta_.push_back(start_.links[i].momentum(motions_[i]));
  }
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
    if (link.parent < 0 || (link.lower == -kNever && link.upper == kNever)) continue;
    JointStop stops[2];
    const double* q = state_.q.data() + link.first_q;
    if (joint_of(link.mobility).find_stops(link, q, stop_margin(link), stops) > 0) return true;
  }
  return false;
}

bool TreeMotion::has_rows() const {
  if (!tree_->loops.empty()) return true;
  for (const TreeLink& link : tree_->links) {
    if (link.friction > 0) return true;
  }
  return false;
}

void TreeMotion::move_joints(const std::vector<double>& displacement) {
  for (TreeLink& link : tree_->links) {
    const Joint& joint = joint_of(link.mobility);
    double* q = state_.q.data() + link.first_q;
    joint.move(displacement.data() + link.first_u, q);
    joint.creep(link, q);
  }
}

void TreeMotion::set_diagonal(double time, double span) {
  diagonal_.assign(tree_->links.size(), 0);
  resistance_.assign(tree_->links.size(), 0);
  for (std::size_t i = 1; has_springs_ && i < tree_->links.size(); ++i) {
    const TreeLink& link = tree_->links[i];
    const double tangent = joint_of(link.mobility)
                               .calc_tangent_stiffness(link, state_.q.data() + link.first_q,
                                                       state_.u.data() + link.first_u);
    resistance_[i] = link.damping + span * tangent;
    diagonal_[i] = time * resistance_[i];
  }
}

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

double TreeMotion::calc_spring_energy() const {
  double sum = 0;
  for (const TreeLink& link : tree_->links) {
    if (link.parent < 0) continue;
    sum += joint_of(link.mobility).calc_spring_energy(link, state_.q.data() + link.first_q);
  }
  return sum;
}

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
    joint_of(link.mobility).add_spring(link, state_.q.data() + link.first_q, f);
    for (int k = 0; k < speed_count(link.mobility); ++k) {
      f[k] -= resistance_[i] * state_.u[std::size_t(link.first_u + k)];
    }
  }
  inertia_.factor(*tree_, end_, diagonal_);
  impulses_.assign(tree_->links.size(), {});
  inertia_.solve(impulses_, forces_, changes_);
  calc_speeds(*tree_, end_, changes_, accelerations);
}

// Gives back what a motion without outer forces, gravity apart, has taken from the momentum, and
// what it has taken from the energy or added to it.
void TreeMotion::conserve(const Sums& wanted, double energy, bool gain) {
  const std::size_t count = motions_.size();
  const Sums now = calc_sums(end_, motions_);
  double share_energy = 0;  // of the motion as one rigid body
  Spatial rigid;
  if (!tree_->has_fixed_root()) {
    const Vec3 centre = now.centre - end_.reference;
    Mat3 inertia;
    for (const LinkPose& link : end_.links) {
      const Vec3 c = link.centre - centre;
      inertia = inertia + link.inertia +
                Mat3{{Vec3{dot(c, c), 0, 0} - c * c.x, Vec3{0, dot(c, c), 0} - c * c.y,
                      Vec3{0, 0, dot(c, c)} - c * c.z}} *
                    link.mass;
    }
    const Mat3 inverse = inverse_of(inertia);
    const auto motion_of = [&](const Vec3& linear, const Vec3& angular) {
      const Vec3 w = inverse * angular;
      return Spatial{w, linear * (1 / tree_->mass) - cross(w, centre)};
    };
    const Spatial lost = motion_of(wanted.linear - now.linear, wanted.angular - now.angular);
    for (Spatial& motion : motions_) motion += lost;
    rigid = motion_of(wanted.linear, wanted.angular);
    share_energy = 0.5 * (dot(wanted.linear, wanted.linear) / tree_->mass +
                          dot(wanted.angular, inverse * wanted.angular));
  }
  const double within = calc_sums(end_, motions_).energy - share_energy;
  const double aim = energy - share_energy;
  if (within > 0) {
    const double most = gain ? 1 + kMostGain : 1;
    const double share = std::sqrt(std::clamp(aim / within, 0.0, most));
    for (std::size_t i = 0; i < count; ++i) motions_[i] = rigid + (motions_[i] - rigid) * share;
  }
  calc_speeds(*tree_, end_, motions_, state_.u);
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
  if (has_springs_) energy += calc_spring_energy();
  if (may_break_) add_weights(end_, 0.5 * h, external_);
  if (fast) {
    take_runge_kutta_step(h);
  } else {
    take_verlet_step(h);
  }
  if (may_break_) add_weights(end_, 0.5 * h, external_);
  calc_motions(*tree_, end_, state_.u, motions_);
  wanted.linear.z -= tree_->mass * gravity_ * h;
  energy -= tree_->mass * gravity_ * calc_sums(end_, motions_).centre.z;
  if (has_springs_) energy -= calc_spring_energy();
  conserve(wanted, energy, !has_springs_);
}

void TreeMotion::move_freely() {
  double fastest = 0;
  for (const Spatial& motion : motions_) fastest = std::max(fastest, norm(motion.angular()));
  const double turn = fastest * step_;
  const bool fast = turn > kFastTurn && !has_springs_;
  const double wanted = std::ceil(turn / (fast ? kTurnPerRungeKutta : kTurnPerSubstep));
  const int substeps = wanted >= kMaxSubsteps ? kMaxSubsteps : std::max(1, int(wanted));
  for (int i = 0; i < substeps; ++i) take_free_step(step_ / substeps, fast);
  end_step();
}

void TreeMotion::begin_substeps(double h) {
  substep_ = h;
  set_diagonal(h, h);
  inertia_.factor(*tree_, start_, diagonal_);
  speeds.begin(inertia_, motions_);
  moved.begin(inertia_, std::vector<Spatial>(motions_.size()), tree_->mass);
  impulses_.assign(motions_.size(), {});
}

// Of the links' weights over a time, about the start's reference.
void TreeMotion::add_weights(const TreePose& pose, double time, std::vector<Spatial>& to) const {
  const Vec3 shift = pose.reference - start_.reference;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const LinkPose& link = pose.links[i];
    const Vec3 weight{0, 0, -gravity_ * time * link.mass};
    to[i] += {cross(link.centre + shift, weight), weight};
  }
}

void TreeMotion::add_forces() {
  add_weights(start_, substep_, impulses_);
  if (may_break_) add_weights(start_, substep_, external_);
  forces_.assign(state_.u.size(), 0);
  for (std::size_t i = 1; has_springs_ && i < tree_->links.size(); ++i) {
    const TreeLink& link = tree_->links[i];
    double* f = forces_.data() + link.first_u;
    joint_of(link.mobility).add_spring(link, state_.q.data() + link.first_q, f);
    for (int k = 0; k < speed_count(link.mobility); ++k) {
      f[k] = substep_ * (f[k] - resistance_[i] * state_.u[std::size_t(link.first_u + k)]);
    }
  }
  inertia_.solve(impulses_, forces_, changes_);
  speeds.add(changes_);
  impulses_.assign(impulses_.size(), {});
}

void TreeMotion::move() {
  speeds.settle();
  for (std::size_t i = 0; i < motions_.size(); ++i) motions_[i] = speeds.motion(std::int32_t(i));
  moved.add(motions_, substep_);
  calc_speeds(*tree_, start_, motions_, state_.u);
  between_ = state_.u;
  for (double& d : between_) d *= substep_;
  move_joints(between_);
}

void TreeMotion::begin_pushes() {
  before_push_.resize(motions_.size());
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    before_push_[i] = moved.motion(std::int32_t(i));
  }
}

void TreeMotion::drop_opposed_speed(double step, double slow) {
  moved.settle();
  double length2 = 0, along = 0;  // u M u and u M push
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const Spatial momentum = start_.links[i].momentum(motions_[i]);
    length2 += dot(momentum, motions_[i]);
    along += dot(momentum, moved.motion(std::int32_t(i)) - before_push_[i]);
  }
  if (along >= 0 || length2 > slow * slow * tree_->mass) return;
  const double keep = std::max(0.0, 1 + along / (step * length2));
  for (Spatial& motion : motions_) motion = motion * keep;
  for (double& speed : state_.u) speed *= keep;
}

// From the speeds at the start's position to those at the end's: what inertia alone does.
void TreeMotion::carry_speeds() {
  const std::size_t count = state_.u.size();
  const Sums before = calc_sums(start_, motions_);
  simbody_->set_speeds(state_.u);
  simbody_->calc_forces(0, forces_);
  simbody_->multiply_by_inverse_mass(forces_, first_);
  between_.resize(count);
  for (std::size_t k = 0; k < count; ++k) between_[k] = state_.u[k] + step_ * first_[k];
  simbody_->set_state({state_.q, between_});
  end_ = simbody_->pose();
  simbody_->calc_forces(0, forces_);
  simbody_->multiply_by_inverse_mass(forces_, second_);
  for (std::size_t k = 0; k < count; ++k) {
    state_.u[k] += 0.5 * step_ * (first_[k] + second_[k]);
  }
  calc_motions(*tree_, end_, state_.u, motions_);
  conserve(before, before.energy + calc_missed_work(), true);
}

// Gravity acted on the speeds at the start's position throughout: what it does to where the links
// have really gone, less what it has done so far. Without this a pendulum gains 10 % a second.
double TreeMotion::calc_missed_work() const {
  double sum = 0;
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const double by_speeds = start_.links[i].centre_velocity(moved.motion(std::int32_t(i))).z;
    const double risen = end_.reference.z + end_.links[i].centre.z - start_.reference.z -
                         start_.links[i].centre.z;
    sum += end_.links[i].mass * (by_speeds - risen);
  }
  return gravity_ * sum;
}

void TreeMotion::finish() {
  moved.settle();
  std::vector<Spatial> pushed(motions_.size());
  for (std::size_t i = 0; i < pushed.size(); ++i) {
    pushed[i] = moved.motion(std::int32_t(i)) - before_push_[i];
  }
  calc_speeds(*tree_, start_, pushed, between_);
  move_joints(between_);
  carry_speeds();
  end_step();
}

void TreeMotion::begin_again() {
  state_ = start_state_;
  if (has_springs_) tree_->links = start_links_;
  calc_motions(*tree_, start_, state_.u, motions_);
  external_.assign(motions_.size(), {});
}

void TreeMotion::end_step() {
  simbody_->set_speeds(state_.u);
  simbody_->calc_world_from_links(world_from_links_);
}

// The change of momentum of all that hangs on a joint, less what others did to it.
void TreeMotion::note_loads() {
  loads_.clear();
  if (!may_break_) return;
  const Vec3 shift = end_.reference - start_.reference;
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const Spatial p = end_.links[i].momentum(motions_[i]);
    loads_.push_back(Spatial{p.angular() + cross(shift, p.linear()), p.linear()});
    loads_[i] -= start_momenta_[i];
    loads_[i] -= external_[i];
  }
  for (std::size_t i = loads_.size(); i-- > 1;) {
    loads_[std::size_t(tree_->links[i].parent)] += loads_[i];
  }
  const double per_step = 1 / step_;
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const TreeLink& link = tree_->links[i];
    const Vec3 joint = world_from_links_[i] * link.link_from_joint.translation - start_.reference;
    loads_[i] = {(loads_[i].angular() - cross(joint, loads_[i].linear())) * per_step,
                 loads_[i].linear() * per_step};
  }
}

}  // namespace rubble
