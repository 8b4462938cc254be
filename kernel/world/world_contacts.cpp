// Impulses of contacts and ties.
#include <algorithm>
#include <utility>

#include "kernel/world/world_impl.h"
#include "kernel/world/world_structures.h"

namespace rubble {
namespace {

constexpr double kSubsteps = SolverSettings{}.substeps;

// Calls action(c) with the impulse of each point of a contact on its second body.
template <typename Action>
void each_contact_point(const WorldData& data, const Pair& pair, const Contact& contact, Action&& action) {
  float sum = 0;
  for (int k = 0; k < contact.count; ++k) sum += contact.points[k].normal_impulse;
  for (int k = 0; k < contact.count; ++k) {
    const ContactPoint& p = contact.points[k];
    const double share = sum > 0 ? double(p.normal_impulse / sum) : 1.0 / contact.count;
    const Body& a = data.bodies[pair.body_a];
    Vec3f speed = -(a.linear + cross(a.angular, p.from_a));
    if (pair.body_b >= 0) {
      const Body& b = data.bodies[pair.body_b];
      speed += b.linear + cross(b.angular, p.from_b);
    }
    ContactImpulse c;
    c.point = a.world_from_com.translation + Vec3(p.from_a);
    c.approach = std::max(0.0, -double(dot(contact.normal, speed)));
    c.impulse = (Vec3(contact.normal) * double(contact.pressed) + Vec3(contact.friction_impulse) * kSubsteps) * share;
    c.piece = pair.collider_b >= 0 ? data.colliders[pair.collider_b].piece : pair.body_b;
    c.other = data.colliders[pair.collider_a].piece;
    action(c);
  }
}

ContactImpulse on_the_other(ContactImpulse c) {
  std::swap(c.piece, c.other);
  c.impulse = -c.impulse;
  return c;
}

std::vector<ContactImpulse> find_impulses(const WorldData& data) {
  std::vector<ContactImpulse> result;
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    if (!data.pairs[i].live || !(data.contacts[i].pressed > 0)) continue;
    each_contact_point(data, data.pairs[i], data.contacts[i], [&result](const ContactImpulse& c) {
      result.push_back(c.piece < 0 ? on_the_other(c) : c);
    });
  }
  return result;
}

}  // namespace

std::vector<ContactImpulse> World::contacts() const { return find_impulses(impl_->data); }

std::vector<ContactLoad> World::Structures::contact_loads() const {
  std::vector<ContactLoad> loads;
  for (const ContactImpulse& c : find_impulses(impl_->data))
    loads.push_back({c.piece, c.other, Vec3f(c.point), Vec3f(c.impulse * (1 / impl_->settings.options.step))});
  return loads;
}

std::vector<ContactImpulse> World::Structures::contact_impulses() const {
  const WorldData& data = impl_->data;
  std::vector<ContactImpulse> result;
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    // What is far apart in memory is looked at last: most pairs are not live.
    const Pair& pair = data.pairs[i];
    if (!pair.live || !(data.contacts[i].pressed > 0)) continue;
    const Contact& contact = data.contacts[i];
    const auto is_bound = [&](std::int32_t collider, std::int32_t body) {
      return collider >= 0 && data.bodies[body].group >= 0;
    };
    const bool of_a = is_bound(pair.collider_a, pair.body_a);
    const bool of_b = is_bound(pair.collider_b, pair.body_b);
    if (!of_a && !of_b) continue;
    each_contact_point(data, pair, contact, [&](const ContactImpulse& c) {
      if (of_a) result.push_back(on_the_other(c));
      if (of_b) result.push_back(c);
    });
  }
  for (const Tie& tie : data.ties) {
    const Contact& contact = tie.contact;
    if (!(contact.pressed > 0)) continue;
    const Vec3 on_b =
        Vec3(contact.normal) * double(contact.pressed) + Vec3(contact.friction_impulse) * kSubsteps;
    const auto note = [&](std::int32_t piece, std::int32_t other, const Vec3f& arm, const Vec3& impulse) {
      if (piece == kGround || impl_->bodies.acting(piece).group < 0) return;
      ContactImpulse c;
      c.piece = piece, c.other = other, c.impulse = impulse;
      c.point = impl_->bodies.acting(piece).world_from_com.translation + Vec3(arm);
      result.push_back(c);
    };
    note(tie.state.piece_a, tie.state.piece_b, contact.points[0].from_a, -on_b);
    note(tie.state.piece_b, tie.state.piece_a, contact.points[0].from_b, on_b);
  }
  return result;
}

}  // namespace rubble
