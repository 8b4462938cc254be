// Who may touch whom: the pairs of a step and their contacts.
#include <algorithm>
#include <cmath>

#include "kernel/surface_contact.h"
#include "kernel/world_impl.h"

namespace rubble {
namespace {

// Parts make points when they are closer than kPointMargin and what a step adds: the fixed margin
// of the search asks for more, and a hair is left for rounding.
constexpr float kSparedMargin = NarrowSettings{}.margin - kPointMargin - 1e-4F;
constexpr double kLookAhead = 4;  // steps that an enlarged box reaches ahead

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
  const double mu_a = types[data.bodies[pair.body_a].type].friction;
  const double mu_b =
      pair.body_b == kGround ? mu_a : types[data.bodies[pair.body_b].type].friction;
  contact.friction = float(std::sqrt(mu_a * mu_b));
  data.pairs.push_back(pair);
  data.contacts.push_back(contact);
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
  for (std::int32_t body : {pair.body_a, pair.body_b}) {
    // A sleeper that loses a support wakes.
    if (body == kGround || data.bodies[body].awake || !data.bodies[body].movable()) continue;
    if (data.contacts[index].rest_pressed > wake_impulse(data.bodies[body])) {
      data.wake_next[body] = 1;
    }
  }
  data.contact_of_pair.erase(pair_key(pair.collider_a, pair.collider_b));
  if (index + 1 < data.pairs.size()) {
    const Pair& moved = data.pairs[index] = data.pairs.back();
    data.contacts[index] = data.contacts.back();
    data.contact_of_pair[pair_key(moved.collider_a, moved.collider_b)] = std::int32_t(index);
  }
  data.pairs.pop_back();
  data.contacts.pop_back();
}

void World::Impl::find_pairs() {
  for (const Body& body : data.bodies) {
    if (!body.awake) continue;
    const Vec3 motion = Vec3(body.linear) * options.step;
    const double turning = double(norm(body.angular) * body.radius) * options.step;
    for (int i = 0; i < body.collider_count; ++i) {
      const int collider = body.first_collider + i;
      Aabb box = data.colliders[collider].box;  // and all that it may sweep in this step
      box.min += min(motion, Vec3{}) - Vec3{turning, turning, turning};
      box.max += max(motion, Vec3{}) + Vec3{turning, turning, turning};
      if (!data.broad.update(collider, box, motion * kLookAhead)) continue;
      data.broad.query(collider, [&](int other) { add_contact(collider, other); });
      if (data.broad.box(collider).min.z < 0) add_contact(collider, kGround);
      update_surface_pairs(collider);
    }
  }
}

// Lists the pairs with somebody awake that may touch in this step, and drops those that are apart.
void World::Impl::select_pairs() {
  active.clear();
  for (std::size_t i = 0; i < data.pairs.size();) {
    Pair& pair = data.pairs[i];
    const bool ground = pair.body_b == kGround;
    if (!data.bodies[pair.body_a].awake && (ground || !data.bodies[pair.body_b].awake)) {
      ++i;
      continue;
    }
    if (is_surface_collider(pair.collider_b)) {  // dropped in find_pairs()
      active.push_back(std::int32_t(i++));
      continue;
    }
    const Aabb& box = data.broad.box(pair.collider_a);
    const bool near =
        ground ? box.min.z < 0 : BroadPhase::overlap(box, data.broad.box(pair.collider_b));
    if (!near) {
      remove_contact(i);
      continue;
    }
    if (may_touch(pair)) {
      active.push_back(std::int32_t(i));
    } else if (pair.live) {
      clear_points(data.contacts[i]);
      pair.live = 0;
    }
    ++i;
  }
}

// Whether the boxes can meet in this step.
bool World::Impl::may_touch(const Pair& pair) const {
  const Body& a = data.bodies[pair.body_a];
  const Aabb& box = data.colliders[pair.collider_a].box;
  if (pair.body_b == kGround) {
    return box.min.z < double(motion_margin(a, nullptr, narrow_settings));
  }
  const Body& b = data.bodies[pair.body_b];
  const double margin = motion_margin(a, &b, narrow_settings);
  if (!pair.live && a.travel + b.travel + margin < pair.apart_until) return false;
  const Aabb& other = data.colliders[pair.collider_b].box;
  return box.min.x <= other.max.x + margin && other.min.x <= box.max.x + margin &&
         box.min.y <= other.max.y + margin && other.min.y <= box.max.y + margin &&
         box.min.z <= other.max.z + margin && other.min.z <= box.max.z + margin;
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
  const float margin = motion_margin(data.bodies[first.body_a], nullptr, narrow_settings);
  update_surface_contacts(slots, posed(collider), collider.box, data.bodies[first.body_b], margin,
                          narrow_settings);
  for (const std::int32_t number : numbers) {
    data.pairs[number].live = data.contacts[number].count > 0;
  }
}

void World::Impl::update_contacts() {
  pool.run(int(active.size()), 64, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Pair& pair = data.pairs[active[i]];
      if (is_surface_collider(pair.collider_b)) {
        if (surface_slot(pair.collider_b) == 0) update_surface_slots(pair);
        continue;
      }
      Contact& contact = data.contacts[active[i]];
      const Body& body = data.bodies[pair.body_a];
      const PosedBody a = posed(data.colliders[pair.collider_a]);
      if (pair.collider_b == kGround) {
        const float margin = motion_margin(body, nullptr, narrow_settings);
        update_ground_contact(contact, a, margin, narrow_settings);
      } else {
        const float margin = motion_margin(body, &data.bodies[pair.body_b], narrow_settings);
        const Body& other = data.bodies[pair.body_b];
        const float apart = update_contact(contact, a, posed(data.colliders[pair.collider_b]),
                                           margin, narrow_settings);
        pair.apart_until = body.travel + other.travel + double(apart + kSparedMargin);
      }
      pair.live = contact.count > 0;
    }
  });
}

}  // namespace rubble
