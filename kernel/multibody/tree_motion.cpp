#include "kernel/multibody/tree_motion.h"

#include <algorithm>
#include <cmath>

#include "kernel/multibody/joints/joint.h"

namespace rubble {
namespace {

constexpr double kStopMargin = 0.02;  // a stop has a row when the joint is so near it; unit: rad, m
constexpr double kFarTurn = 0.2;      // from this turn of a link in a step on, where a tree points at the end is not well known; unit: rad

}  // namespace

void TreeMotion::begin(Tree& tree, SimbodyTree& simbody, double gravity, double step) {
  tree_ = &tree;
  simbody_ = &simbody;
  state_ = simbody.state();
  gravity_ = gravity;
  step_ = step;
  has_springs_ = false;
  feels_loads_ = tree.driven;
  for (const TreeLink& link : tree.links) {
    has_springs_ = has_springs_ || link.stiffness > 0 || link.damping > 0;
    feels_loads_ = feels_loads_ || link.break_force < kNever || link.break_torque < kNever;
  }
  start_ = simbody.pose();
  end_ = start_;
  calc_motions(tree, start_, state_.u, motions_);
  start_state_ = state_;
  start_links_.clear();
  if (has_springs_) start_links_ = tree.links;
  impelled = false;
  external_.assign(tree.links.size(), {});
  contacts_.assign(tree.links.size(), {});
  start_momenta_.clear();
  for (std::size_t i = 0; feels_loads_ && i < motions_.size(); ++i) {
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
    if (link.friction > 0 || link.motor.on) return true;
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
  if (feels_loads_) add_weights(start_, substep_, external_);
  forces_.assign(state_.u.size(), 0);
  for (std::size_t i = 1; has_springs_ && i < tree_->links.size(); ++i) {
    const TreeLink& link = tree_->links[i];
    double* f = forces_.data() + link.first_u;
    add_spring(i, f);
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
  conserve(before, before.energy + calc_missed_work(), true, farthest_turn() > kFarTurn);
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
  contacts_.assign(motions_.size(), {});
}

void TreeMotion::end_step() {
  simbody_->set_speeds(state_.u);
  simbody_->calc_world_from_links(world_from_links_);
  if (tree_->driven) note_work();
}

// The change of momentum of all that hangs on a joint, less what others did to it.
void TreeMotion::note_loads() {
  loads_.clear();
  if (!feels_loads_) return;
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
  if (tree_->driven) note_link_loads();
}

void TreeMotion::note_link_loads() {
  const double per_step = 1 / step_;
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    LinkLoads& to = tree_->links[i].loads;
    const Spatial contact = contacts_[i] * per_step;
    to.contact_force = contact.linear();
    to.contact_moment = contact.angular() - cross(start_.links[i].centre, contact.linear());
    to.joint_force = tree_->links[i].parent < 0 ? Vec3{} : loads_[i].linear();
    to.joint_moment = tree_->links[i].parent < 0 ? Vec3{} : loads_[i].angular();
  }
}

// Of the motors in a step: their mean torques times the turns of their joints.
void TreeMotion::note_work() {
  for (TreeLink& link : tree_->links) {
    if (!link.motor.on) continue;
    const std::size_t at = std::size_t(link.first_q);
    link.motor.work += link.motor.mean * (state_.q[at] - start_state_.q[at]);
  }
}

}  // namespace rubble
