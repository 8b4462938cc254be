#include "kernel/world/phases/pair_selection.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kLookAhead = 4;  // number of steps that an enlarged box reaches ahead

// What becomes of a pair in a step.
enum PairState : std::uint8_t {
  kAsleep,   // neither moves
  kApart,    // the enlarged boxes have parted: it is dropped
  kWaiting,  // too far apart to touch in this step
  kActive,
};

// Bounds on lengths that are found in another order of rounding are this much wider.
constexpr float kRounding = 1.001F;
// Boxes are not looked at until their pieces have travelled this share of the gap between them: so nothing is
// missed where a piece goes twice as far as its travel says.
constexpr double kTrustedShare = 0.5;
// And less this, for the rounding of corners; unit: m
constexpr double kHair = 1e-3;

}  // namespace

void PairSelection::run(StepPairs& step) {
  find_pairs(step);
  select_pairs(step);
}

// Of those that do not move all is zero but the travel.
void PairSelection::note_sweeps(StepPairs& step) {
  step.sweeps.assign(data_.bodies.size(), {});
  for (std::size_t i = 0; i < step.sweeps.size(); ++i) step.sweeps[i].travel = data_.bodies[i].travel;
  pool_.run(int(step.awake.size()), 128, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const Body& body = data_.bodies[step.awake[k]];
      StepMotion& sweep = step.sweeps[step.awake[k]];
      sweep.awake = true;
      sweep.linear = body.linear;
      sweep.turning = norm(body.angular) * body.radius;
      sweep.reach = settings_.narrow.step * (norm(body.linear) + sweep.turning) * kRounding;
    }
  });
}

// All that a part may sweep in this step.
Aabb PairSelection::calc_swept_box(int collider) const {
  const Body& body = data_.bodies[data_.colliders[collider].body];
  const Vec3 motion = Vec3(body.linear) * settings_.options.step;
  const double turning = double(norm(body.angular) * body.radius) * settings_.options.step;
  Aabb box = data_.colliders[collider].box;
  box.min += min(motion, Vec3{}) - Vec3{turning, turning, turning};
  box.max += max(motion, Vec3{}) + Vec3{turning, turning, turning};
  return box;
}

// Their boxes are enlarged anew.
void PairSelection::find_leaving(const StepPairs& step) {
  const std::size_t count = data_.colliders.size();
  leaves_box_.assign(count, 0);
  box_before_.resize(count), box_after_.resize(count);
  pool_.run(int(step.awake.size()), 64, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const Body& body = data_.bodies[step.awake[k]];
      const Vec3 motion = Vec3(body.linear) * settings_.options.step;
      bodies_.each_collider(body, [&](int i) {
        const Aabb swept = calc_swept_box(i);
        if (data_.broad.holds(i, swept)) return;
        leaves_box_[i] = 1;
        box_before_[i] = data_.broad.box(i);
        box_after_[i] = BroadPhase::enlarge(swept, motion * kLookAhead);
      });
    }
  });
}

// Those that it meets now and did not before: a pair lives as long as its boxes overlap, and what parts bodies finds their
// pairs. Of two that leave their boxes the later names the pair.
void PairSelection::find_neighbours(int collider, std::vector<std::int32_t>& out) const {
  data_.broad.find(collider, out);
  const auto is_known = [&](std::int32_t other) {
    if (!leaves_box_[other]) return BroadPhase::overlap(box_before_[collider], data_.broad.box(other));
    return other > collider || BroadPhase::overlap(box_before_[collider], box_before_[other]);
  };
  out.erase(std::remove_if(out.begin(), out.end(), is_known), out.end());
}

void PairSelection::find_pairs(StepPairs& step) {
  step.list_awake(data_.bodies);
  note_sweeps(step);
  find_leaving(step);
  const std::vector<std::int32_t>& leaving = leaving_.find(int(leaves_box_.size()), pool_, [&](int i) { return leaves_box_[i]; });
  for (const std::int32_t collider : leaving) data_.broad.place(collider, box_after_[collider]);
  if (neighbours_.size() < leaving.size()) neighbours_.resize(leaving.size());
  pool_.run(int(leaving.size()), 16, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) find_neighbours(leaving[k], neighbours_[k]);
  });
  for (std::size_t k = 0; k < leaving.size(); ++k) {
    const std::int32_t collider = leaving[k];
    for (const std::int32_t other : neighbours_[k]) pairs_.add(collider, other);
    if (data_.broad.box(collider).min.z < 0) pairs_.add(collider, kGround);
    pairs_.update_near_surfaces(collider);
  }
}

// Lists the pairs with somebody awake that may touch in this step, and drops those that are apart.
void PairSelection::select_pairs(StepPairs& step) {
  pair_states_.resize(data_.pairs.size());
  pool_.run(int(data_.pairs.size()), 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Pair& pair = data_.pairs[i];
      pair_states_[i] = classify(step, pair);
      if (pair_states_[i] != kWaiting || !pair.live) continue;
      clear_points(data_.contacts[i]);
      pair.live = 0;
    }
  });
  step.active.clear();
  for (std::size_t i = 0; i < data_.pairs.size();) {
    const std::uint8_t state = pair_states_[i];
    if (state == kApart) {
      pairs_.remove(i);  // the last one takes its place
      pair_states_[i] = pair_states_[data_.pairs.size()];
      continue;
    }
    if (state == kActive) step.active.push_back(std::int32_t(i));
    ++i;
  }
}

std::uint8_t PairSelection::classify(const StepPairs& step, Pair& pair) const {
  const bool ground = pair.body_b == kGround;
  if (!step.sweeps[pair.body_a].awake && (ground || !step.sweeps[pair.body_b].awake)) return kAsleep;
  if (is_surface_collider(pair.collider_b)) return kActive;  // dropped by Pairs
  if (!is_near(pair)) return kApart;
  return may_touch(step, pair) ? kActive : kWaiting;
}

// Whether the enlarged boxes overlap. They did when the pair was made, and only one that has been
// enlarged anew can have parted.
bool PairSelection::is_near(const Pair& pair) const {
  const bool ground = pair.body_b == kGround;
  if (!leaves_box_[pair.collider_a] && (ground || !leaves_box_[pair.collider_b])) return true;
  const Aabb& box = data_.broad.box(pair.collider_a);
  return ground ? box.min.z < 0 : BroadPhase::overlap(box, data_.broad.box(pair.collider_b));
}

// How far the boxes are apart along the axis where they are farthest; unit: m.
double PairSelection::calc_gap(const Aabb& a, const Aabb& b) {
  const Vec3 gap = max(a.min - b.max, b.min - a.max);
  return std::max({gap.x, gap.y, gap.z});
}

// Whether the boxes can meet in this step.
bool PairSelection::may_touch(const StepPairs& step, Pair& pair) const {
  if (pair.body_b == kGround) {
    return data_.colliders[pair.collider_a].box.min.z <
           double(step.calc_margin(pair.body_a, kGround, settings_.narrow));
  }
  const StepMotion &a = step.sweeps[pair.body_a], &b = step.sweeps[pair.body_b];
  const double travel = a.travel + b.travel;
  const float most = settings_.narrow.margin * kRounding + a.reach + b.reach;
  // First what is known without a look at the boxes, which are far apart in memory.
  if (!pair.live && travel + double(most) < pair.apart_until) return false;
  const Aabb& box = data_.colliders[pair.collider_a].box;
  const Aabb& other = data_.colliders[pair.collider_b].box;
  const auto meet = [&](double margin) {
    return box.min.x <= other.max.x + margin && other.min.x <= box.max.x + margin &&
           box.min.y <= other.max.y + margin && other.min.y <= box.max.y + margin &&
           box.min.z <= other.max.z + margin && other.min.z <= box.max.z + margin;
  };
  if (!meet(most)) {
    const double until = travel + kTrustedShare * calc_gap(box, other) - kHair;
    pair.apart_until = std::max(pair.apart_until, until);
    return false;
  }
  const double margin = step.calc_margin(pair.body_a, pair.body_b, settings_.narrow);
  if (!pair.live && travel + margin < pair.apart_until) return false;
  return meet(margin);
}

}  // namespace rubble
