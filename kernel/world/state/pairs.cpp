#include "kernel/world/state/pairs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/collision/surface_contact.h"

namespace rubble {

std::uint64_t pair_key(std::int32_t a, std::int32_t b) {
  return std::uint64_t(std::uint32_t(a)) << 32 | std::uint32_t(b);
}

void Pairs::introduce(int first) {
  const int count = int(data_.bodies.size());
  for (int i = first; i < count; ++i) {
    Body& body = data_.bodies[i];
    if (body.lead < 0 || body.lead == i) bodies_.refresh(body);  // a lead refreshes the pieces of its group
    for (int c = 0; c < body.collider_count && !body.lost; ++c) {
      const int collider = body.first_collider + c;
      data_.broad.place(collider, BroadPhase::enlarge(data_.colliders[collider].box, {}));
    }
  }
  const std::size_t before = surfaces_.size();
  list_surfaces();
  // What was there before may lie near a surface that is new.
  for (int i = surfaces_.size() > before ? 0 : first; i < count; ++i) {
    if (!data_.bodies[i].lost) find_first(i);
  }
}

void Pairs::find_first(int index) {
  const Body& body = data_.bodies[index];
  bodies_.each_collider(body, [&](int collider) {
    data_.broad.find(collider, found_);
    for (const std::int32_t other : found_) add(collider, other);
    if (body.mass > 0) add(collider, kGround);
    update_near_surfaces(collider);
  });
}

void Pairs::add(int first, int second) {
  const int a = second == kGround ? first : std::min(first, second);
  const int b = second == kGround ? kGround : std::max(first, second);
  const std::int32_t body_a = data_.colliders[a].body;
  const std::int32_t body_b = b == kGround ? kGround : data_.colliders[b].body;
  if (body_a == body_b) return;
  if (b != kGround && are_joined(body_a, body_b)) return;
  const Body& one = data_.bodies[body_a];
  if (b != kGround && !one.movable() && !data_.bodies[body_b].movable()) return;
  if (!data_.contact_of_pair.insert({pair_key(a, b), std::int32_t(data_.contacts.size())}).second) {
    return;
  }
  push({a, b, body_a, body_b});
}

void Pairs::push(const Pair& pair) {
  Contact& contact = data_.contacts.emplace_back();
  contact.body_a = pair.body_a;
  contact.body_b = pair.body_b;
  const double mu_a = bodies_.friction_of(pair.collider_a);
  const double mu_b = pair.body_b == kGround ? mu_a
                      : is_surface_collider(pair.collider_b)
                          ? types_.pieces[data_.bodies[pair.body_b].type].friction
                          : bodies_.friction_of(pair.collider_b);
  contact.friction = float(std::sqrt(mu_a * mu_b));
  data_.pairs.push_back(pair);
}

void Pairs::update_near_surfaces(int collider) {
  const std::int32_t body = data_.colliders[collider].body;
  if (data_.bodies[body].mass <= 0) return;
  for (const std::int32_t surface : surfaces_) {
    const PosedSurface posed_surface(data_.bodies[surface]);
    const bool near = posed_surface.surface->meets(posed_surface.to_local(data_.broad.box(collider)));
    for (int slot = 0; slot < kSurfaceSlots; ++slot) {
      const std::int32_t other = surface_collider(surface, slot);
      const auto known = data_.contact_of_pair.find(pair_key(collider, other));
      if (near == (known != data_.contact_of_pair.end())) continue;
      if (!near) {
        remove(std::size_t(known->second));
        continue;
      }
      data_.contact_of_pair[pair_key(collider, other)] = std::int32_t(data_.contacts.size());
      push({collider, other, body, surface});
    }
  }
}

void Pairs::remove(std::size_t index) {
  const Pair pair = data_.pairs[index];
  waking_.note_lost_contact(data_.contacts[index]);
  data_.contact_of_pair.erase(pair_key(pair.collider_a, pair.collider_b));
  if (index + 1 < data_.pairs.size()) {
    const Pair& moved = data_.pairs[index] = data_.pairs.back();
    data_.contacts[index] = std::move(data_.contacts.back());
    data_.contact_of_pair[pair_key(moved.collider_a, moved.collider_b)] = std::int32_t(index);
  }
  data_.pairs.pop_back();
  data_.contacts.pop_back();
}

void Pairs::list_surfaces() {
  surfaces_.clear();
  for (std::size_t i = 0; i < data_.bodies.size(); ++i) {
    if (data_.bodies[i].shape->surface) surfaces_.push_back(std::int32_t(i));
  }
}

bool Pairs::are_joined(int body_a, int body_b) const {
  const Body &a = data_.bodies[body_a], &b = data_.bodies[body_b];
  if (a.tree >= 0 && a.tree == b.tree) {
    const std::vector<TreeLink>& links = data_.trees[a.tree].links;
    if (data_.trees[a.tree].tube && std::abs(a.link - b.link) <= 2) return true;
    const TreeLink &one = links[a.link], &other = links[b.link];
    if (one.parent == b.link) return !one.collide;
    if (other.parent == a.link) return !other.collide;
    for (const TreeLoop& loop : data_.trees[a.tree].loops) {
      const bool these =
          (loop.link_a == a.link && loop.link_b == b.link) || (loop.link_a == b.link && loop.link_b == a.link);
      if (these) return !loop.collide;
    }
  }
  return false;
}

}  // namespace rubble
