#include "kernel/world/phases/sleep.h"

#include <cmath>

#include "kernel/world/phases/contact_search.h"

namespace rubble {
namespace {

// When a piece falls asleep, and what wakes it.
struct SleepTerms {
  // It sleeps after it has stayed within this distance for this time.
  double still_distance;  // of any of its points; unit: m
  double still_time;      // unit: s
  // So does one that jitters, but goes nowhere.
  double loose_distance;  // unit: m
  double loose_time;      // unit: s
  // It wakes when the impulse of a contact changes by what would give it this speed, and this share
  // of its load on top.
  float wake_speed;  // unit: m/s
  float wake_load;
  // It wakes at once when an impact would give it this speed.
  float hit_speed;  // unit: m/s
};
// While a pile grows, what lies still enough sleeps: most of it will be hit again. It must wake as
// readily as ever, or slopes freeze steeper than they can stand.
constexpr SleepTerms kGrowing{0.0015, 0.2, 0.006, 0.6, 0.1F, 0.25F, 0.05F};
// Whether it rests is decided on these: who creeps slowly must not pass for one that stays.
constexpr SleepTerms kVerifying{0.001, 0.5, 0.004, 1.0, 0.1F, 0.25F, 0.05F};

// Who has gone farther than this in `still_time`, while rest is verified, has to stay for twice that time: at a
// steady acceleration it would go four times as far. unit: m
constexpr double kSurelyStill = 0.0003;
// A piece that has only stayed within `loose_distance` goes faster and faster if its latest pace is larger than its
// mean by this factor. unit: 1
constexpr double kHasteningRatio = 1.5;
constexpr double kHasteningPace = 0.002;  // and if it is larger than this; unit: m/s
constexpr double kPaceTime = 0.25;        // the shortest time over which a pace is taken; unit: s

constexpr double kSleepOverlapTime = 2.0;  // time for which a deep overlap keeps a piece awake; unit: s

// A sleeping piece wakes at once if the impulse of a hit exceeds its mass times `hit_speed`, plus this share of
// the impulse that it carries in a step. unit: 1
constexpr float kHitLoad = 0.2F;
// Or if what the hit gives along the ground exceeds all that friction can take up in a step, plus its mass times this
// speed: little holds on ice. unit: m/s
constexpr float kSlipSpeed = 0.0005F;

// A sleeper wakes when a robot presses on it with this share of its weight; unit: 1.
constexpr float kRobotTouch = 0.001F;
// So many contacts away from a robot nothing that is awake falls asleep.
constexpr int kPushedContacts = 3;

const SleepTerms& terms(const WorldData& data) { return data.verification_steps < 0 ? kGrowing : kVerifying; }
// normal: of the contact that hits, unit length.
float hit_impulse(const Body& body, const SleepTerms& t, const Vec3f& normal) {
  const float held = t.hit_speed * float(body.mass) + kHitLoad * body.load;
  const float slips = body.grip + kSlipSpeed * float(body.mass), level2 = 1 - normal.z * normal.z;
  return slips * slips < held * held * level2 ? slips / std::sqrt(level2) : held;
}

// An impulse in a step that would give a sleeper this speed is none that it bore. Far above what heavy pieces press with that
// rest on light ones: where that is limited, too, three of twenty piles on a hill do not rest, and at 300 m/s two of 68 piles
// drift by more than 5 cm. unit: m/s
constexpr float kThrown = 2000;

// How far any point of a body may have gone from `pose`; unit: m.
double calc_departure(const Body& body, const Vec3f& reach, const Pose& pose) {
  const Vec3 moved = body.world_from_com.translation - pose.translation;
  const Quat turn = pose.rotation.conjugate() * body.world_from_com.rotation;
  // How far a corner has gone at most: a bar may spin about its own axis without going anywhere.
  const Vec3 r = Vec3(reach) * (2 * body.scale);
  const Vec3 t{std::abs(turn.x), std::abs(turn.y), std::abs(turn.z)};
  return norm(moved) + norm(Vec3{t.y * r.z + t.z * r.y, t.z * r.x + t.x * r.z, t.x * r.y + t.y * r.x});
}

// Counts the steps that a body has stayed near `pose`; starts anew where it is when it has left.
void count_still(const Body& body, const Vec3f& reach, double distance, Pose& pose, std::int32_t& steps) {
  ++steps;
  if (calc_departure(body, reach, pose) <= distance) return;
  pose = body.world_from_com;
  steps = 0;
}

// The same of the looser terms while rest is verified. Who goes slowly leaves one pose after another, each
// piece at its own time, so that seldom all have stayed at once: it goes on with a later pose that it is
// still near to, and takes the next such pose after each `wait` steps.
void count_loose(Body& body, const Vec3f& reach, double distance, int wait) {
  ++body.loose_steps, ++body.later_steps;
  const auto go_on = [&body] {
    body.loose_pose = body.later_pose, body.loose_steps = body.later_steps;
    body.later_pose = body.world_from_com, body.later_steps = 0;
  };
  const bool left = calc_departure(body, reach, body.loose_pose) > distance;
  if (left && calc_departure(body, reach, body.later_pose) > distance) {
    body.later_pose = body.world_from_com, body.later_steps = 0;
    go_on();
  } else if (left || body.later_steps >= wait) {
    go_on();
  }
}

}  // namespace

// What carries a high load is clamped by it, and changes of a fraction of the load do not matter.
float Sleep::wake_impulse(const Body& body) const {
  const float steps = float(settings_.options.step * kStepsPerSecond);
  return terms(data_).wake_speed * steps * float(body.mass) + terms(data_).wake_load * body.load;
}

void Sleep::fall_asleep(int index) {
  Body& body = data_.bodies[index];
  body.awake = false;
  if (body.free_index >= 0) blocks_.set_velocity(body.free_index, {}, {});
  if (body.tree >= 0) trees_.stop(body.tree);
  body.linear = {};
  body.angular = {};
}

// The sleeper of a pair that its other body is about to hit that hard; kGround: there is none.
std::int32_t Sleep::find_hit(const StepPairs& step, std::int32_t index) const {
  const Pair& pair = data_.pairs[index];
  if (!pair.live || pair.body_b == kGround) return kGround;
  if (step.sweeps[pair.body_a].awake == step.sweeps[pair.body_b].awake) return kGround;
  const Contact& contact = data_.contacts[index];
  const Body &a = data_.bodies[contact.body_a], &b = data_.bodies[contact.body_b];
  if (a.awake == b.awake) return kGround;
  const Body& sleeper = a.awake ? b : a;
  if (!sleeper.movable()) return kGround;
  const float inverse_masses = a.inverse_mass + b.inverse_mass;
  const float least = inverse_masses * hit_impulse(sleeper, terms(data_), contact.normal);
  for (int i = 0; i < contact.count; ++i) {
    const ContactPoint& p = contact.points[i];
    const Vec3f v = b.linear + cross(b.angular, p.from_b) - a.linear - cross(a.angular, p.from_a);
    const float approach = -dot(contact.normal, v);
    if (p.separation - approach * settings_.solver.step > settings_.solver.rest_gap) continue;
    // The impulse of a central plastic impact.
    if (approach >= least) return a.awake ? contact.body_b : contact.body_a;
  }
  return kGround;
}

void Sleep::wake_hit(StepPairs& step) {
  const std::vector<std::int32_t>& hits =
      wanted_.find(int(step.active.size()), pool_, [&](int k) { return find_hit(step, step.active[k]) != kGround; });
  if (hits.empty()) return;
  for (const std::int32_t k : hits) {
    const std::int32_t sleeper = find_hit(step, step.active[k]);
    if (sleeper != kGround) waking_.wake(sleeper);  // else one before has woken it
  }
  step.list_awake(data_.bodies);
  listed_.assign(data_.pairs.size(), 0);
  for (std::int32_t index : step.active) listed_[index] = 1;
  const std::vector<std::int32_t>& more = wanted_.find(int(data_.pairs.size()), pool_, [&](int i) {
    const Pair& pair = data_.pairs[i];
    if (listed_[i] != 0 || !pair.live) return false;
    return data_.bodies[pair.body_a].awake || (pair.body_b != kGround && data_.bodies[pair.body_b].awake);
  });
  for (const std::int32_t i : more) {
    step.active.push_back(i);
    step.is_deep[i] = overlaps_deep(data_.contacts[i]);
  }
}

// Sleepers that an awake neighbour presses on more, or less, than when they fell asleep; and those
// whose contacts no longer add up to what they were.
void Sleep::wake_changed(const StepPairs& step) {
  lost_support_.resize(data_.bodies.size());
  unsettled_.clear(), throwing_.clear();
  each_solved_fact(data_, step, [&](const SolvedContact& facts, const auto& get) {
    if (!facts.at_sleeper) return;
    Contact& contact = get();
    for (std::int32_t i : {contact.body_a, contact.body_b}) {
      if (i == kGround) continue;
      const Body& body = data_.bodies[i];
      if (body.awake || !body.movable()) continue;
      const float change = contact.pressed - contact.rest_pressed;
      if (std::abs(change) > wake_impulse(body) || touches_robot(contact)) data_.wake_next[i] = 1;
      lost_support_[i] += contact.normal * (i == contact.body_a ? change : -change);
      unsettled_.push_back(i);
      if (contact.pressed > kThrown * float(body.mass)) throwing_.push_back({&contact, i});
    }
  });
  for (std::int32_t i : unsettled_) {
    const Body& body = data_.bodies[i];
    if (waking_.is_unbalanced(body, body.lost_support + lost_support_[i])) data_.wake_next[i] = 1;
  }
  for (std::int32_t i : unsettled_) lost_support_[i] = {};
  for (const auto& [contact, sleeper] : throwing_) {
    if (data_.wake_next[sleeper]) limit_warm_start(data_.bodies[sleeper], *contact);
  }
}

// A sleeper was solved as immovable. What pressed on it then would throw it away when it wakes: a slab of 57 t that
// swings at 7 cm/s pressed with 10,000 N s on a brick of 3 kg that lay on it. So where that is far beyond what it can
// bear, the contact starts with what it carried when the piece fell asleep, which may double, and the weight in a step; the
// solver finds what is more.
void Sleep::limit_warm_start(const Body& sleeper, Contact& contact) const {
  const auto weight = float(sleeper.mass * settings_.options.gravity * settings_.options.step);
  const float share = (2 * contact.rest_pressed + weight) / contact.pressed;
  if (share >= 1) return;
  for (int k = 0; k < contact.count; ++k) contact.points[k].normal_impulse *= share;
  contact.friction_impulse *= share, contact.twist_impulse *= share;
}

void Sleep::find_overlapping(const StepPairs& step) {
  overlapping_.assign(data_.bodies.size(), 0);
  for (std::int32_t index : step.active) {
    if (!step.is_deep[index]) continue;
    const Pair& pair = data_.pairs[index];
    overlapping_[pair.body_a] = 1;
    if (pair.body_b != kGround) overlapping_[pair.body_b] = 1;
  }
}

// What the pieces that fell asleep in this step carry.
void Sleep::note_loads(const StepPairs& step) {
  for (std::size_t i = 0; i < slept_.size(); ++i) {
    if (slept_[i]) data_.bodies[i].load = data_.bodies[i].grip = 0;
  }
  each_solved(data_, step, [&](Contact& contact) {
    for (std::int32_t i : {contact.body_a, contact.body_b}) {
      if (i == kGround || !slept_[i]) continue;
      data_.bodies[i].load += contact.pressed;
      data_.bodies[i].grip += contact.friction * contact.pressed;
      contact.rest_pressed = contact.pressed;
    }
  });
}

// Of the awake ones; slept_: who has stayed for long enough to fall asleep, unless rest is verified.
void Sleep::count_still_steps(const StepPairs& step) {
  const SleepTerms& t = terms(data_);
  const double duration = settings_.options.step;
  const int wait = int(t.still_time / duration), loose_wait = int(t.loose_time / duration);
  const int long_wait = int(kSleepOverlapTime / duration);
  const bool verifying = data_.verification_steps >= 0;
  slept_.assign(data_.bodies.size(), 0);
  pool_.run(int(step.awake.size()), 128, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::int32_t i = step.awake[k];
      Body& body = data_.bodies[i];
      if (!body.awake) continue;
      const Vec3f& reach = bodies_.reach_of(body);
      count_still(body, reach, t.still_distance, body.still_pose, body.still_steps);
      if (verifying) {
        count_loose(body, reach, t.loose_distance, loose_wait);
        continue;
      }
      count_still(body, reach, t.loose_distance, body.loose_pose, body.loose_steps);
      slept_[i] = body.still_steps >= (overlapping_[i] ? long_wait : wait) ||
                  body.loose_steps >= (overlapping_[i] ? long_wait : loose_wait);
    }
  });
}

void Sleep::run(const StepPairs& step) {
  wake_changed(step);
  if (!settings_.options.sleeping) return;
  find_overlapping(step);
  count_still_steps(step);
  if (data_.verification_steps >= 0) return update_verification(step);
  stay_awake_near_robots(step);
  trees_.keep_whole(slept_);
  put_to_sleep(step);
}

// Those that `slept_` marks.
void Sleep::put_to_sleep(const StepPairs& step) {
  bool any = false;
  for (std::size_t i = 0; i < slept_.size(); ++i) {
    if (!slept_[i]) continue;
    fall_asleep(int(i));
    any = true;
  }
  if (any) note_loads(step);
}

void Sleep::put_all_to_sleep(const StepPairs& step) {
  slept_.assign(data_.bodies.size(), 0);
  for (std::size_t i = 0; i < slept_.size(); ++i) slept_[i] = data_.bodies[i].awake;
  put_to_sleep(step);
  data_.verification_steps = -1;
}

// Whether a piece that stays near its loose pose goes faster and faster: it will not stay for long.
bool Sleep::is_hastening(const Body& body) const {
  const double step = settings_.options.step;
  const Vec3f& reach = bodies_.reach_of(body);
  const double pace = calc_departure(body, reach, body.loose_pose) / (double(body.loose_steps) * step);
  const int least = int(kPaceTime / step);
  const bool apart = body.later_steps >= least && body.loose_steps >= body.later_steps + least;
  const double later = apart ? calc_departure(body, reach, body.later_pose) / (double(body.later_steps) * step)
                             : double(norm(body.linear));
  return later > kHasteningPace && later > kHasteningRatio * pace;
}

bool Sleep::within_rest_tolerance(const Body& body) const {
  const SleepTerms& t = kVerifying;
  const int wait = int(t.still_time / settings_.options.step);
  if (body.still_steps >= 2 * wait) return true;
  if (body.still_steps >= wait && calc_departure(body, bodies_.reach_of(body), body.still_pose) <= kSurelyStill) {
    return true;
  }
  return body.loose_steps >= int(t.loose_time / settings_.options.step) && !is_hastening(body);
}

bool Sleep::is_driven(std::int32_t body) const {
  if (body == kGround || data_.bodies[body].tree < 0) return false;
  return data_.trees[data_.bodies[body].tree].driven;
}

// Whether one side is a robot that presses on the other, a movable piece.
bool Sleep::touches_robot(const Contact& contact) const {
  if (data_.robots.empty() || contact.body_b == kGround) return false;
  const bool a = is_driven(contact.body_a), b = is_driven(contact.body_b);
  if (a == b) return false;
  const Body& piece = data_.bodies[a ? contact.body_b : contact.body_a];
  return contact.pressed > kRobotTouch * float(piece.mass * settings_.options.gravity * settings_.options.step);
}

// Falling asleep takes what speed is left: not from what a robot pushes, nor from what that pushes.
void Sleep::stay_awake_near_robots(const StepPairs& step) {
  if (data_.robots.empty()) return;
  std::vector<std::uint8_t> ring(data_.bodies.size(), 0);
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = is_driven(std::int32_t(i)) ? 1 : 0;
  for (int k = 1; k <= kPushedContacts; ++k) {
    for (std::int32_t index : step.active) {
      const Contact& contact = data_.contacts[index];
      if (contact.body_b == kGround || contact.pressed <= 0) continue;
      std::uint8_t &a = ring[std::size_t(contact.body_a)], &b = ring[std::size_t(contact.body_b)];
      if (a == k && b == 0) b = std::uint8_t(k + 1);
      if (b == k && a == 0) a = std::uint8_t(k + 1);
    }
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i] > 0) slept_[i] = 0;
  }
}

}  // namespace rubble
