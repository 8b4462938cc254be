// Pieces that hold together as one rigid body, and come apart.
//
// A group moves as its lead, the lowest of its pieces: that one's Body has the mass, the pose and the
// speeds of all. The others keep their numbers, types and colliders, and count as immovable. As pieces of
// a group keep the orientation that they were bound in, a piece is known by its offset alone.
#include <algorithm>
#include <utility>

#include "kernel/base/inertia.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

constexpr double kSubsteps = SolverSettings{}.substeps;

}  // namespace

Body& World::Impl::acting(int piece) {
  Body& body = data.bodies[piece];
  return body.lead >= 0 ? data.bodies[body.lead] : body;
}

const Body& World::Impl::acting(int piece) const {
  const Body& body = data.bodies[piece];
  return body.lead >= 0 ? data.bodies[body.lead] : body;
}

const Vec3f& World::Impl::reach_of(const Body& body) const {
  return body.group >= 0 ? data.groups[body.group].reach : body.shape->reach;
}

double World::Impl::collider_friction(std::int32_t collider) const {
  return types[data.bodies[data.colliders[collider].piece].type].friction;
}

// Corners from the group's centre of mass, and boxes.
void World::Impl::refresh_group(Body& body) {
  body.rotation = to_float(body.world_from_com.rotation.matrix());
  if (body.mass > 0) {
    body.inverse_inertia = body.rotation * body.inverse_inertia_local * body.rotation.transposed();
  }
  const Vec3& centre = body.world_from_com.translation;
  for (const std::int32_t member : data.groups[body.group].members) {
    const Body& piece = data.bodies[member];
    const Vec3f offset(piece.origin_in_group + piece.shape->volume.centre_of_mass);
    for (int i = 0; i < piece.collider_count; ++i) {
      Collider& collider = data.colliders[piece.first_collider + i];
      const auto& corners = piece.shape->parts[collider.part].corners;
      Aabb box;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3f p = body.rotation * (corners[k] + offset);
        data.corners[collider.first_corner + k] = p;
        box.include(centre + Vec3(p));
      }
      collider.box = box;
    }
  }
}

void World::Impl::bind(int first, int count) {
  SplitPart all;
  all.fixed = true;
  for (int i = first; i < first + count; ++i) all.pieces.push_back(i);
  const Body whole = data.bodies[first];
  form_group(all, whole);
  for (std::size_t i = 0; i < data.pairs.size();) {
    const Pair& pair = data.pairs[i];
    const auto is_member = [&](std::int32_t body) { return body >= first && body < first + count; };
    if (is_member(pair.body_a) || is_member(pair.body_b)) {
      remove_contact(i);  // found anew below
    } else {
      ++i;
    }
  }
  find_first_pairs(first);
}

// Mass, centre and inertia of a group, in the lead; the pieces' offsets are from wherever.
void World::Impl::weigh(Body& body, const RigidGroup& group) {
  double mass = 0;
  Vec3 centre;
  for (const std::int32_t member : group.members) {
    const Body& piece = data.bodies[member];
    const double m = types[piece.type].density * piece.shape->volume.volume;
    mass += m;
    centre += (piece.origin_in_group + piece.shape->volume.centre_of_mass) * m;
  }
  centre *= 1 / mass;
  Mat3 inertia{};
  for (const std::int32_t member : group.members) {
    Body& piece = data.bodies[member];
    piece.origin_in_group -= centre;
    const VolumeProperties& volume = piece.shape->volume;
    const double density = types[piece.type].density;
    inertia = inertia + volume.inertia * density;
    add_offset(inertia, density * volume.volume, piece.origin_in_group + volume.centre_of_mass);
  }
  body.com_in_type = -body.origin_in_group;
  body.world_from_com.translation += body.world_from_com.rotation.rotate(centre);
  body.mass = mass;
  body.inertia = inertia;
}

// The pieces' offsets are still those of `whole`.
void World::Impl::form_group(const SplitPart& part, const Body& whole) {
  const std::int32_t lead = part.pieces[0];
  RigidGroup group;
  group.members.assign(part.pieces.begin(), part.pieces.end());
  const bool bound = whole.group >= 0;
  for (const std::int32_t member : group.members) {
    Body& piece = data.bodies[member];
    if (!bound) {  // as add_body() laid it
      piece.origin_in_group = whole.world_from_com.rotation.conjugate().rotate(
          piece.world_from_type().translation - whole.world_from_com.translation);
    }
    piece.lead = lead;
    piece.group = -1;
    for (int i = 0; i < piece.collider_count; ++i) data.colliders[piece.first_collider + i].body = lead;
  }
  Body& body = data.bodies[lead];
  const std::int32_t simbody_index = body.simbody_index;
  body.world_from_com = whole.world_from_com;
  weigh(body, group);
  body.simbody_index = simbody_index;
  body.travel = whole.travel;
  body.has_touched = whole.has_touched, body.touching = false;
  body.load = 0, body.lost_support = {};
  body.radius = 0;
  for (const std::int32_t member : group.members) {
    const Body& piece = data.bodies[member];
    const Vec3f offset(piece.origin_in_group + piece.shape->volume.centre_of_mass);
    for (const ConvexShape& convex : piece.shape->parts) {
      for (const Vec3f& corner : convex.corners) {
        const Vec3f p = corner + offset;
        body.radius = std::max(body.radius, norm(p));
        group.reach = max(group.reach, max(p, -p));
      }
    }
  }
  body.group = std::int32_t(data.groups.size());
  data.groups.push_back(std::move(group));
  if (part.fixed) {
    body.mass = 0;
    body.awake = false;
    refresh(body);
    return;
  }
  body.inverse_mass = float(1 / body.mass);
  body.inverse_inertia_local = to_float(inverse_of(body.inertia));
  body.awake = true;
  body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
  body.still_steps = body.loose_steps = body.later_steps = 0;
}

// Gives the free ones of the new bodies coordinates and speeds: neighbours share a block.
void World::Impl::set_free(const std::vector<SplitPart>& parts, const Body& whole, const Vec3& linear,
                           const Vec3& angular) {
  std::vector<FreeBody> fresh;
  std::vector<std::int32_t> bodies;
  for (const SplitPart& part : parts) {
    if (part.fixed) continue;
    Body& body = data.bodies[part.pieces[0]];
    const Vec3 moved = body.world_from_com.translation - whole.world_from_com.translation;
    const Vec3 velocity = linear + cross(angular, moved);
    bodies.push_back(part.pieces[0]);
    if (body.simbody_index < 0) {
      fresh.push_back({body.mass, body.inertia, body.world_from_com, velocity, angular});
    } else {
      blocks.set_pose(body.simbody_index, body.world_from_com);
      blocks.set_velocity(body.simbody_index, velocity, angular);
    }
  }
  int index = fresh.empty() ? 0 : blocks.add(fresh);
  for (const std::int32_t i : bodies) {
    Body& body = data.bodies[i];
    if (body.simbody_index < 0) body.simbody_index = index++;
    mirror(body);
    refresh(body);
  }
}

// Contacts that named the old lead: their colliders know who moves them now, and points are measured
// from another centre.
void World::Impl::move_contacts(const Vec3& old_centre, int old_lead) {
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    Pair& pair = data.pairs[i];
    Contact& contact = data.contacts[i];
    const auto move = [&](std::int32_t& of_pair, std::int32_t& of_contact, std::int32_t collider,
                          Vec3f ContactPoint::*from, Vec3f ContactPoint::*local) {
      if (of_pair != old_lead || collider < 0) return;
      of_pair = of_contact = data.colliders[collider].body;
      const Body& body = data.bodies[of_pair];
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

void World::Impl::split(int lead, const std::vector<SplitPart>& parts) {
  const Body whole = data.bodies[lead];
  const Vec3 linear = linear_velocity(whole), angular = angular_velocity(whole);
  const std::int32_t old_group = whole.group;
  data.verification_steps = -1;
  for (const SplitPart& part : parts) form_group(part, whole);
  set_free(parts, whole, linear, angular);
  data.groups[old_group] = {};
  move_contacts(whole.world_from_com.translation, lead);
  for (const SplitPart& part : parts) {
    if (!part.fixed) find_first_pairs(part.pieces[0]);
  }
}

void World::bind(int first, int count) { impl_->bind(first, count); }

void World::split(const std::vector<SplitPart>& parts) {
  impl_->split(impl_->data.bodies[parts[0].pieces[0]].lead, parts);
}

std::vector<int> World::bound_with(int index) const {
  const Body& body = impl_->acting(index);
  if (body.group < 0) return {index};
  const std::vector<std::int32_t>& members = impl_->data.groups[body.group].members;
  return {members.begin(), members.end()};
}

Vec3 World::centre_velocity(int index) const {
  return impl_->linear_velocity(impl_->acting(index));
}

void World::set_on_solved(std::function<bool()> on_solved) { impl_->on_solved = std::move(on_solved); }

std::vector<ContactImpulse> World::contact_impulses() const {
  const WorldData& data = impl_->data;
  std::vector<ContactImpulse> result;
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    const Pair& pair = data.pairs[i];
    const Contact& contact = data.contacts[i];
    const auto is_bound = [&](std::int32_t collider, std::int32_t body) {
      return collider >= 0 && data.bodies[body].group >= 0;
    };
    const bool of_a = is_bound(pair.collider_a, pair.body_a);
    const bool of_b = is_bound(pair.collider_b, pair.body_b);
    if (!pair.live || !(contact.pressed > 0) || !(of_a || of_b)) continue;
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
      const Vec3 on_b = (Vec3(contact.normal) * double(contact.pressed) +
                         Vec3(contact.friction_impulse) * kSubsteps) * share;
      const int a_piece = data.colliders[pair.collider_a].piece;
      const int b_piece = pair.collider_b >= 0 ? data.colliders[pair.collider_b].piece : pair.body_b;
      if (of_a) c.piece = a_piece, c.other = b_piece, c.impulse = -on_b, result.push_back(c);
      if (of_b) c.piece = b_piece, c.other = a_piece, c.impulse = on_b, result.push_back(c);
    }
  }
  for (const Tie& tie : data.ties) {
    const Contact& contact = tie.contact;
    if (!(contact.pressed > 0)) continue;
    const Vec3 on_b = Vec3(contact.normal) * double(contact.pressed) +
                      Vec3(contact.friction_impulse) * kSubsteps;
    const auto note = [&](std::int32_t piece, std::int32_t other, const Vec3f& arm, const Vec3& impulse) {
      if (piece == kGround || impl_->acting(piece).group < 0) return;
      ContactImpulse c;
      c.piece = piece, c.other = other, c.impulse = impulse;
      c.point = impl_->acting(piece).world_from_com.translation + Vec3(arm);
      result.push_back(c);
    };
    note(tie.state.piece_a, tie.state.piece_b, contact.points[0].from_a, -on_b);
    note(tie.state.piece_b, tie.state.piece_a, contact.points[0].from_b, on_b);
  }
  return result;
}

}  // namespace rubble
