#include "kernel/world/state/groups.h"

#include <algorithm>
#include <utility>

#include "kernel/base/inertia.h"

namespace rubble {

void RigidGroups::bind(int first, int count) {
  SplitPart all;
  all.fixed = true;
  for (int i = first; i < first + count; ++i) all.pieces.push_back(i);
  const Body whole = data_.bodies[first];
  form(all, whole);
  const auto is_member = [&](std::int32_t body) { return body >= first && body < first + count; };
  pairs_.remove_if([&](const Pair& pair) {  // found anew below
    return is_member(pair.body_a) || is_member(pair.body_b);
  });
  pairs_.find_first(first);
}

void RigidGroups::lay(const SplitPart& part, FreeBody* free) {
  const Body whole = data_.bodies[part.pieces[0]];
  form(part, whole);
  const Body& body = data_.bodies[part.pieces[0]];
  if (!part.fixed) *free = {body.mass, body.inertia, body.world_from_com, {}, {}};
}

// The pieces' offsets are still those of `whole`.
void RigidGroups::form(const SplitPart& part, const Body& whole) {
  const std::int32_t lead = part.pieces[0];
  RigidGroup group;
  group.members.assign(part.pieces.begin(), part.pieces.end());
  const bool bound = whole.group >= 0;
  for (const std::int32_t member : group.members) {
    Body& piece = data_.bodies[member];
    if (!bound) {  // as Bodies::add() laid it
      piece.origin_in_group = whole.world_from_com.rotation.conjugate().rotate(
          piece.world_from_type().translation - whole.world_from_com.translation);
    }
    piece.lead = lead;
    piece.group = -1;
    for (int i = 0; i < piece.collider_count; ++i) data_.colliders[piece.first_collider + i].body = lead;
  }
  Body& body = data_.bodies[lead];
  const std::int32_t free_index = body.free_index;
  body.world_from_com = whole.world_from_com;
  bodies_.weigh(body, group);
  body.free_index = free_index;
  body.travel = whole.travel;
  body.has_touched = whole.has_touched, body.touching = false;
  body.load = body.grip = 0, body.lost_support = {};
  body.radius = 0;
  for (const std::int32_t member : group.members) {
    const Body& piece = data_.bodies[member];
    const Vec3f offset(piece.origin_in_group + piece.shape->volume.centre_of_mass);
    for (const ConvexShape& convex : piece.shape->parts) {
      for (const Vec3f& corner : convex.corners) {
        const Vec3f p = corner + offset;
        body.radius = std::max(body.radius, norm(p));
        group.reach = max(group.reach, max(p, -p));
      }
    }
  }
  body.group = std::int32_t(data_.groups.size());
  data_.groups.push_back(std::move(group));
  if (part.fixed) {
    body.mass = 0;
    body.awake = false;
    bodies_.refresh(body);
    return;
  }
  body.inverse_mass = float(1 / body.mass);
  body.inverse_inertia_local = to_float(inverse_of(body.inertia));
  body.awake = true;
  body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
  body.still_steps = body.loose_steps = body.later_steps = 0;
}

// Gives the free ones of the new bodies coordinates and speeds: neighbours share a block.
void RigidGroups::set_free(const std::vector<SplitPart>& parts, const Body& whole, const Vec3& linear,
                           const Vec3& angular) {
  std::vector<FreeBody> fresh;
  std::vector<std::int32_t> bodies;
  for (const SplitPart& part : parts) {
    if (part.fixed) continue;
    Body& body = data_.bodies[part.pieces[0]];
    const Vec3 moved = body.world_from_com.translation - whole.world_from_com.translation;
    const Vec3 velocity = linear + cross(angular, moved);
    bodies.push_back(part.pieces[0]);
    if (body.free_index < 0) {
      fresh.push_back({body.mass, body.inertia, body.world_from_com, velocity, angular});
    } else {
      blocks_.set_pose(body.free_index, body.world_from_com);
      blocks_.set_velocity(body.free_index, velocity, angular);
    }
  }
  int index = fresh.empty() ? 0 : blocks_.add(fresh);
  for (const std::int32_t i : bodies) {
    Body& body = data_.bodies[i];
    if (body.free_index < 0) body.free_index = index++;
    bodies_.mirror(body);
    bodies_.refresh(body);
  }
}

// Contacts that named the old lead: their colliders know who moves them now, and points are measured
// from another centre.
void RigidGroups::move_contacts(const Vec3& old_centre, int old_lead) {
  for (std::size_t i = 0; i < data_.pairs.size(); ++i) {
    Pair& pair = data_.pairs[i];
    Contact& contact = data_.contacts[i];
    const auto move = [&](std::int32_t& of_pair, std::int32_t& of_contact, std::int32_t collider,
                          Vec3f ContactPoint::*from, Vec3f ContactPoint::*local) {
      if (of_pair != old_lead || collider < 0) return;
      of_pair = of_contact = data_.colliders[collider].body;
      const Body& body = data_.bodies[of_pair];
      const Vec3f shift(old_centre - body.world_from_com.translation);
      const Vec3f turned_shift = body.rotation.transposed() * shift;
      for (int k = 0; k < contact.count; ++k) {
        contact.points[k].*from += shift;
        contact.points[k].*local += turned_shift;
      }
    };
    move(pair.body_a, contact.body_a, pair.collider_a, &ContactPoint::from_a, &ContactPoint::local_a);
    move(pair.body_b, contact.body_b, pair.collider_b, &ContactPoint::from_b, &ContactPoint::local_b);
  }
}

void RigidGroups::move_fixed(int lead, const Vec3& by) {
  Body& body = data_.bodies[lead];
  body.world_from_com.translation += by;
  body.travel += norm(by);
  data_.verification_steps = -1;
  bodies_.refresh(body);
  bodies_.each_collider(body, [&](int collider) {
    data_.broad.place(collider, BroadPhase::enlarge(data_.colliders[collider].box, {}));
  });
  pairs_.find_first(lead);
}

void RigidGroups::split(int lead, const std::vector<SplitPart>& parts) {
  const Body whole = data_.bodies[lead];
  const Vec3 linear = bodies_.linear_velocity(whole), angular = bodies_.angular_velocity(whole);
  const std::int32_t old_group = whole.group;
  data_.verification_steps = -1;
  for (const SplitPart& part : parts) form(part, whole);
  set_free(parts, whole, linear, angular);
  data_.groups[old_group] = {};
  move_contacts(whole.world_from_com.translation, lead);
  for (const SplitPart& part : parts) {
    if (!part.fixed) pairs_.find_first(part.pieces[0]);
  }
}

}  // namespace rubble
