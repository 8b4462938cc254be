// Who may touch whom: the pairs of a step and their contacts.
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/collision/surface_contact.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

// Parts make points when they are closer than kPointMargin and what a step adds: the fixed margin
// of the search asks for more, and a hair is left for rounding.
constexpr float kSparedMargin = NarrowSettings{}.margin - kPointMargin - 1e-4F;
// Where two parts have moved by less than this in all since the last search, their points only move
// along: normals and lengths change by the square of it over their size; unit: m.
constexpr double kFollowedTravel = 1e-4;
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

std::uint64_t pair_key(std::int32_t a, std::int32_t b) {
  return std::uint64_t(std::uint32_t(a)) << 32 | std::uint32_t(b);
}

}  // namespace

void World::Impl::add_contact(int first, int second) {
  const int a = second == kGround ? first : std::min(first, second);
  const int b = second == kGround ? kGround : std::max(first, second);
  const std::int32_t body_a = data.colliders[a].body;
  const std::int32_t body_b = b == kGround ? kGround : data.colliders[b].body;
  if (body_a == body_b) return;
  if (b != kGround && are_joined(body_a, body_b)) return;
  const Body& one = data.bodies[body_a];
  if (b != kGround && !one.movable() && !data.bodies[body_b].movable()) return;
  if (!data.contact_of_pair.insert({pair_key(a, b), std::int32_t(data.contacts.size())}).second) {
    return;
  }
  push_contact({a, b, body_a, body_b});
}

void World::Impl::push_contact(const Pair& pair) {
  Contact contact;
  contact.body_a = pair.body_a;
  contact.body_b = pair.body_b;
  const double mu_a = collider_friction(pair.collider_a);
  const double mu_b = pair.body_b == kGround ? mu_a
                      : is_surface_collider(pair.collider_b)
                          ? types[data.bodies[pair.body_b].type].friction
                          : collider_friction(pair.collider_b);
  contact.friction = float(std::sqrt(mu_a * mu_b));
  data.pairs.push_back(pair);
  data.contacts.push_back(std::move(contact));
}

// A part near a surface has all slots there, far from it none.
void World::Impl::update_surface_pairs(int collider) {
  const std::int32_t body = data.colliders[collider].body;
  if (data.bodies[body].mass <= 0) return;
  for (const std::int32_t surface : surfaces) {
    const PosedSurface posed_surface(data.bodies[surface]);
    const bool near =
        posed_surface.surface->meets(posed_surface.to_local(data.broad.box(collider)));
    for (int slot = 0; slot < kSurfaceSlots; ++slot) {
      const std::int32_t other = surface_collider(surface, slot);
      const auto known = data.contact_of_pair.find(pair_key(collider, other));
      if (near == (known != data.contact_of_pair.end())) continue;
      if (!near) {
        remove_contact(std::size_t(known->second));
        continue;
      }
      data.contact_of_pair[pair_key(collider, other)] = std::int32_t(data.contacts.size());
      push_contact({collider, other, body, surface});
    }
  }
}

void World::Impl::remove_contact(std::size_t index) {
  const Pair pair = data.pairs[index];
  note_lost_contact(data.contacts[index]);
  data.contact_of_pair.erase(pair_key(pair.collider_a, pair.collider_b));
  if (index + 1 < data.pairs.size()) {
    const Pair& moved = data.pairs[index] = data.pairs.back();
    data.contacts[index] = std::move(data.contacts.back());
    data.contact_of_pair[pair_key(moved.collider_a, moved.collider_b)] = std::int32_t(index);
  }
  data.pairs.pop_back();
  data.contacts.pop_back();
}

void World::Impl::list_awake() {
  awake_bodies.clear();
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    if (data.bodies[i].awake) awake_bodies.push_back(std::int32_t(i));
  }
}

// Of those that do not move all is zero.
void World::Impl::note_sweeps() {
  sweeps.assign(data.bodies.size(), {});
  pool.run(int(awake_bodies.size()), 128, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const Body& body = data.bodies[awake_bodies[k]];
      Sweep& sweep = sweeps[awake_bodies[k]];
      sweep.awake = true;
      sweep.linear = body.linear;
      sweep.turning = norm(body.angular) * body.radius;
      sweep.reach = narrow_settings.step * (norm(body.linear) + sweep.turning) * kRounding;
    }
  });
}

// All that a part may sweep in this step.
Aabb World::Impl::calc_swept_box(int collider) const {
  const Body& body = data.bodies[data.colliders[collider].body];
  const Vec3 motion = Vec3(body.linear) * options.step;
  const double turning = double(norm(body.angular) * body.radius) * options.step;
  Aabb box = data.colliders[collider].box;
  box.min += min(motion, Vec3{}) - Vec3{turning, turning, turning};
  box.max += max(motion, Vec3{}) + Vec3{turning, turning, turning};
  return box;
}

void World::Impl::find_pairs() {
  list_awake();
  note_sweeps();
  leaves_box.assign(data.colliders.size(), 0);
  pool.run(int(awake_bodies.size()), 64, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const Body& body = data.bodies[awake_bodies[k]];
      each_collider(body, [&](int i) { leaves_box[i] = !data.broad.holds(i, calc_swept_box(i)); });
    }
  });
  for (std::size_t i = 0; i < leaves_box.size(); ++i) {
    if (!leaves_box[i]) continue;
    const int collider = int(i);
    const Vec3 motion = Vec3(data.bodies[data.colliders[i].body].linear) * options.step;
    data.broad.update(collider, calc_swept_box(collider), motion * kLookAhead);
    data.broad.query(collider, [&](int other) { add_contact(collider, other); });
    if (data.broad.box(collider).min.z < 0) add_contact(collider, kGround);
    update_surface_pairs(collider);
  }
}

// Lists the pairs with somebody awake that may touch in this step, and drops those that are apart.
void World::Impl::select_pairs() {
  pair_states.resize(data.pairs.size());
  pool.run(int(data.pairs.size()), 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) pair_states[i] = classify(data.pairs[i]);
  });
  active.clear();
  for (std::size_t i = 0; i < data.pairs.size();) {
    const std::uint8_t state = pair_states[i];
    if (state == kApart) {
      remove_contact(i);  // the last one takes its place
      pair_states[i] = pair_states[data.pairs.size()];
      continue;
    }
    if (state == kActive) active.push_back(std::int32_t(i));
    if (state == kWaiting && data.pairs[i].live) {
      clear_points(data.contacts[i]);
      data.pairs[i].live = 0;
    }
    ++i;
  }
}

std::uint8_t World::Impl::classify(const Pair& pair) const {
  const bool ground = pair.body_b == kGround;
  if (!sweeps[pair.body_a].awake && (ground || !sweeps[pair.body_b].awake)) return kAsleep;
  if (is_surface_collider(pair.collider_b)) return kActive;  // dropped in find_pairs()
  if (!is_near(pair)) return kApart;
  return may_touch(pair) ? kActive : kWaiting;
}

// Whether the enlarged boxes overlap. They did when the pair was made, and only one that has been
// enlarged anew can have parted.
bool World::Impl::is_near(const Pair& pair) const {
  const bool ground = pair.body_b == kGround;
  if (!leaves_box[pair.collider_a] && (ground || !leaves_box[pair.collider_b])) return true;
  const Aabb& box = data.broad.box(pair.collider_a);
  return ground ? box.min.z < 0 : BroadPhase::overlap(box, data.broad.box(pair.collider_b));
}

float World::Impl::calc_margin(int body_a, int body_b) const {
  const Sweep& a = sweeps[body_a];
  if (body_b == kGround) return motion_margin(a.linear, a.turning, narrow_settings);
  const Sweep& b = sweeps[body_b];
  return motion_margin(a.linear - b.linear, a.turning + b.turning, narrow_settings);
}

// Whether the boxes can meet in this step.
bool World::Impl::may_touch(const Pair& pair) const {
  const Aabb& box = data.colliders[pair.collider_a].box;
  if (pair.body_b == kGround) return box.min.z < double(calc_margin(pair.body_a, kGround));
  const Aabb& other = data.colliders[pair.collider_b].box;
  const auto meet = [&](double margin) {
    return box.min.x <= other.max.x + margin && other.min.x <= box.max.x + margin &&
           box.min.y <= other.max.y + margin && other.min.y <= box.max.y + margin &&
           box.min.z <= other.max.z + margin && other.min.z <= box.max.z + margin;
  };
  const float most = narrow_settings.margin * kRounding + sweeps[pair.body_a].reach +
                     sweeps[pair.body_b].reach;
  if (!meet(most)) return false;
  const double margin = calc_margin(pair.body_a, pair.body_b);
  const Body &a = data.bodies[pair.body_a], &b = data.bodies[pair.body_b];
  if (!pair.live && a.travel + b.travel + margin < pair.apart_until) return false;
  return meet(margin);
}

// All slots of a part at once.
void World::Impl::update_surface_slots(const Pair& first) {
  Contact* slots[kSurfaceSlots];
  std::int32_t numbers[kSurfaceSlots];
  for (int slot = 0; slot < kSurfaceSlots; ++slot) {
    numbers[slot] = data.contact_of_pair.at(
        pair_key(first.collider_a, surface_collider(first.body_b, slot)));
    slots[slot] = &data.contacts[numbers[slot]];
  }
  const Collider& collider = data.colliders[first.collider_a];
  const float margin = calc_margin(first.body_a, kGround);
  update_surface_contacts(slots, posed(collider), collider.box, data.bodies[first.body_b], margin,
                          narrow_settings);
  for (const std::int32_t number : numbers) {
    data.pairs[number].live = data.contacts[number].count > 0;
    note_overlap(number);
  }
}

void World::Impl::update_pair(Pair& pair, Contact& contact) {
  const PosedBody a = posed(data.colliders[pair.collider_a]);
  const float margin = calc_margin(pair.body_a, pair.body_b);
  if (pair.collider_b == kGround) {
    update_ground_contact(contact, a, margin, narrow_settings);
    pair.live = contact.count > 0;
    return;
  }
  const PosedBody b = posed(data.colliders[pair.collider_b]);
  const double travel = data.bodies[pair.body_a].travel + data.bodies[pair.body_b].travel;
  if (pair.live && travel < pair.searched_until) return follow_contact(contact, a, b);
  const float apart = update_contact(contact, a, b, margin, narrow_settings);
  pair.apart_until = travel + double(apart + kSparedMargin);
  pair.searched_until = travel + kFollowedTravel;
  pair.live = contact.count > 0;
}

// While the contact is at hand.
void World::Impl::note_overlap(std::int32_t index) {
  const Contact& contact = data.contacts[index];
  is_deep[index] = overlaps_deep(contact);
  may_be_stuck[index] = dot(contact.way_out, contact.way_out) > 0 || is_stuck(contact);
}

void World::Impl::update_contacts() {
  is_deep.resize(data.pairs.size());
  may_be_stuck.resize(data.pairs.size());
  pool.run(int(active.size()), 64, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Pair& pair = data.pairs[active[i]];
      if (is_surface_collider(pair.collider_b)) {
        if (surface_slot(pair.collider_b) == 0) update_surface_slots(pair);
        continue;
      }
      update_pair(pair, data.contacts[active[i]]);
      note_overlap(active[i]);
    }
  });
}

}  // namespace rubble
