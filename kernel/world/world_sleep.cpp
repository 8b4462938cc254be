// Who takes part in a step: falling asleep, and being woken.
#include <cmath>

#include "kernel/world/world_impl.h"

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

// A sleeping piece wakes if the vector sum of its contact impulses has changed, since it fell asleep, by more
// than this speed times its mass ... unit: m/s
constexpr float kUnbalancedSpeed = 0.01F;
// ... plus this share of its load. A load that one neighbour takes over from another changes nothing. unit: 1
constexpr float kUnbalancedLoad = 0.05F;

// The speeds above are those of steps of 1/60 s: in a shorter step a force gives less speed.
constexpr double kStepsPerSecond = 60;  // unit: 1/s

// Overlaps deeper than this keep a piece awake for kSleepOverlapTime.
constexpr float kSleepOverlap = 0.003F;    // unit: m
constexpr double kSleepOverlapTime = 2.0;  // time for which a deep overlap keeps a piece awake; unit: s

// A sleeping piece wakes at once if the impulse of a hit exceeds its mass times `hit_speed`, plus this share of
// the impulse that it carries in a step. unit: 1
constexpr float kHitLoad = 0.2F;

const SleepTerms& terms(const WorldData& data) {
  return data.verification_steps < 0 ? kGrowing : kVerifying;
}
float hit_impulse(const Body& body, const SleepTerms& t) {
  return t.hit_speed * float(body.mass) + kHitLoad * body.load;
}

// How far any point of a body may have gone from `pose`; unit: m.
double calc_departure(const Body& body, const Vec3f& reach, const Pose& pose) {
  const Vec3 moved = body.world_from_com.translation - pose.translation;
  const Quat turn = pose.rotation.conjugate() * body.world_from_com.rotation;
  // How far a corner has gone at most: a bar may spin about its own axis without going anywhere.
  const Vec3 r = Vec3(reach) * (2 * body.scale);
  const Vec3 t{std::abs(turn.x), std::abs(turn.y), std::abs(turn.z)};
  return norm(moved) +
         norm(Vec3{t.y * r.z + t.z * r.y, t.z * r.x + t.x * r.z, t.x * r.y + t.y * r.x});
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
float World::Impl::wake_impulse(const Body& body) const {
  const float steps = float(options.step * kStepsPerSecond);
  return terms(data).wake_speed * steps * float(body.mass) + terms(data).wake_load * body.load;
}

void World::Impl::wake(int index) {
  Body& body = data.bodies[index];
  if (!body.movable() || body.awake) return;
  if (body.tree >= 0) {  // all of it at once
    for (const TreeLink& link : data.trees[body.tree].links) wake_one(data.bodies[link.body]);
  } else {
    wake_one(body);
  }
}

void World::Impl::wake_one(Body& body) {
  if (!body.movable()) return;
  body.awake = true;
  body.lost_support = {};
  body.still_steps = body.loose_steps = 0;
  body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
  body.later_steps = 0;
}

void World::Impl::fall_asleep(int index) {
  Body& body = data.bodies[index];
  body.awake = false;
  if (body.simbody_index >= 0) blocks.set_velocity(body.simbody_index, {}, {});
  if (body.tree >= 0) stop_tree(body.tree);
  body.linear = {};
  body.angular = {};
}

void World::Impl::wake_marked() {
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    if (data.wake_next[i]) wake(int(i));
    data.wake_next[i] = 0;
  }
}

// A sleeper that is about to be hit hard enough takes part in this very step, so that momentum is
// kept. Its other contacts are as it left them: neither side has moved.
void World::Impl::wake_hit() {
  bool any = false;
  for (std::int32_t index : active) {
    const Pair& pair = data.pairs[index];
    if (!pair.live || pair.body_b == kGround) continue;
    if (sweeps[pair.body_a].awake == sweeps[pair.body_b].awake) continue;
    const Contact& contact = data.contacts[index];
    const Body &a = data.bodies[contact.body_a], &b = data.bodies[contact.body_b];
    if (a.awake == b.awake) continue;
    const Body& sleeper = a.awake ? b : a;
    if (!sleeper.movable()) continue;
    const float inverse_masses = a.inverse_mass + b.inverse_mass;
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint& p = contact.points[i];
      const Vec3f v = b.linear + cross(b.angular, p.from_b) - a.linear - cross(a.angular, p.from_a);
      const float approach = -dot(contact.normal, v);
      if (p.separation - approach * solver_settings.step > solver_settings.rest_gap) continue;
      // The impulse of a central plastic impact.
      if (approach < inverse_masses * hit_impulse(sleeper, terms(data))) continue;
      wake(a.awake ? contact.body_b : contact.body_a);
      any = true;
      break;
    }
  }
  if (!any) return;
  list_awake();
  std::vector<std::uint8_t> listed(data.pairs.size(), 0);
  for (std::int32_t index : active) listed[index] = 1;
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    const Pair& pair = data.pairs[i];
    if (listed[i] || !pair.live) continue;
    const bool awake = data.bodies[pair.body_a].awake ||
                       (pair.body_b != kGround && data.bodies[pair.body_b].awake);
    if (!awake) continue;
    active.push_back(std::int32_t(i));
    is_deep[i] = overlaps_deep(data.contacts[i]);
  }
}

bool World::Impl::is_unbalanced(const Body& body, const Vec3f& change) const {
  const float steps = float(options.step * kStepsPerSecond);
  const float most = kUnbalancedSpeed * steps * float(body.mass) + kUnbalancedLoad * body.load;
  return dot(change, change) > most * most;
}

// A contact that is about to be forgotten: what it gave to sleepers is gone.
void World::Impl::note_lost_contact(const Contact& contact) {
  for (std::int32_t i : {contact.body_a, contact.body_b}) {
    if (i == kGround || data.bodies[i].awake || !data.bodies[i].movable()) continue;
    Body& body = data.bodies[i];
    body.lost_support += contact.normal * (i == contact.body_a ? -contact.rest_pressed
                                                               : contact.rest_pressed);
    if (is_unbalanced(body, body.lost_support)) data.wake_next[i] = 1;
  }
}

// Sleepers that an awake neighbour presses on more, or less, than when they fell asleep; and those
// whose contacts no longer add up to what they were.
void World::Impl::wake_changed() {
  lost_support.resize(data.bodies.size());
  unsettled.clear();
  each_solved([this](const Contact& contact) {
    if (sweeps[contact.body_a].awake && (contact.body_b == kGround || sweeps[contact.body_b].awake)) return;
    for (std::int32_t i : {contact.body_a, contact.body_b}) {
      if (i == kGround) continue;
      const Body& body = data.bodies[i];
      if (body.awake || !body.movable()) continue;
      const float change = contact.pressed - contact.rest_pressed;
      if (std::abs(change) > wake_impulse(body) || touches_robot(contact)) data.wake_next[i] = 1;
      lost_support[i] += contact.normal * (i == contact.body_a ? change : -change);
      unsettled.push_back(i);
    }
  });
  for (std::int32_t i : unsettled) {
    const Body& body = data.bodies[i];
    if (is_unbalanced(body, body.lost_support + lost_support[i])) data.wake_next[i] = 1;
  }
  for (std::int32_t i : unsettled) lost_support[i] = {};
}

bool World::Impl::overlaps_deep(const Contact& contact) {
  for (int p = 0; p < contact.count; ++p) {
    if (contact.points[p].separation <= -kSleepOverlap) return true;
  }
  return false;
}

void World::Impl::find_overlapping() {
  overlapping.assign(data.bodies.size(), 0);
  for (std::int32_t index : active) {
    if (!is_deep[index]) continue;
    const Pair& pair = data.pairs[index];
    overlapping[pair.body_a] = 1;
    if (pair.body_b != kGround) overlapping[pair.body_b] = 1;
  }
}

// What the pieces that fell asleep in this step carry.
void World::Impl::note_loads() {
  for (std::size_t i = 0; i < slept.size(); ++i) {
    if (slept[i]) data.bodies[i].load = 0;
  }
  each_solved([this](Contact& contact) {
    for (std::int32_t i : {contact.body_a, contact.body_b}) {
      if (i == kGround || !slept[i]) continue;
      data.bodies[i].load += contact.pressed;
      contact.rest_pressed = contact.pressed;
    }
  });
}

void World::Impl::update_sleep() {
  wake_changed();
  if (!options.sleeping) return;
  find_overlapping();
  const SleepTerms& t = terms(data);
  const int wait = int(t.still_time / options.step), loose_wait = int(t.loose_time / options.step);
  const int long_wait = int(kSleepOverlapTime / options.step);
  slept.assign(data.bodies.size(), 0);
  const bool verifying = data.verification_steps >= 0;
  pool.run(int(awake_bodies.size()), 128, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::int32_t i = awake_bodies[k];
      Body& body = data.bodies[i];
      if (!body.awake) continue;
      count_still(body, reach_of(body), t.still_distance, body.still_pose, body.still_steps);
      if (verifying) {
        count_loose(body, reach_of(body), t.loose_distance, loose_wait);
      } else {
        count_still(body, reach_of(body), t.loose_distance, body.loose_pose, body.loose_steps);
      }
      slept[i] = !verifying && (body.still_steps >= (overlapping[i] ? long_wait : wait) ||
                                body.loose_steps >= (overlapping[i] ? long_wait : loose_wait));
    }
  });
  if (verifying) return update_verification();
  stay_awake_near_robots();
  keep_trees_whole();
  put_to_sleep();
}

// Those that `slept` marks.
void World::Impl::put_to_sleep() {
  bool any = false;
  for (std::size_t i = 0; i < slept.size(); ++i) {
    if (!slept[i]) continue;
    fall_asleep(int(i));
    any = true;
  }
  if (any) note_loads();
}

// Whether a piece has stayed where it is for long enough to count as at rest.
bool World::Impl::within_rest_tolerance(const Body& body) const {
  const SleepTerms& t = kVerifying;
  return body.still_steps >= int(t.still_time / options.step) ||
         body.loose_steps >= int(t.loose_time / options.step);
}

}  // namespace rubble
