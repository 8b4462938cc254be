// Every member of what a world's next steps depend on, listed once, in order: what is written is
// what is read. A member that is added to one of these structs must be added here; the test
// WorldFields.EveryMemberIsListed says so when it is forgotten. Not for use outside kernel/.
#pragma once

#include <type_traits>

#include "kernel/multibody/free_bodies.h"
#include "kernel/multibody/simbody_trees.h"
#include "kernel/world/state/world_data.h"
#include "kernel/world/world.h"

namespace rubble {

struct World::Snapshot {
  std::uint64_t types = 0;  // hash_types() of the world's types
  WorldData data;
  std::vector<FreeBody> free;              // by number in FreeBodies
  std::vector<std::int32_t> block_starts;  // number of each block's first body
  std::vector<TreeState> tree_states;      // by number of the tree
};

// Struct is T or const T.
template <typename Struct, typename T>
using IfIs = std::enable_if_t<std::is_same_v<std::remove_const_t<Struct>, T>, int>;

template <typename Struct, typename Visit, IfIs<Struct, Body> = 0>
void each_field(Struct& b, Visit&& visit) {
  visit(b.type), visit(b.layer), visit(b.scale), visit(b.shape), visit(b.mass);
  visit(b.com_in_type), visit(b.inertia), visit(b.inverse_inertia_local), visit(b.inverse_mass);
  visit(b.radius), visit(b.free_index), visit(b.tree), visit(b.link), visit(b.first_collider), visit(b.collider_count);
  visit(b.lead), visit(b.group), visit(b.origin_in_group);
  visit(b.world_from_com), visit(b.linear), visit(b.angular), visit(b.rotation);
  visit(b.inverse_inertia), visit(b.travel), visit(b.still_pose), visit(b.still_steps);
  visit(b.loose_pose), visit(b.loose_steps);
  visit(b.later_pose), visit(b.later_steps), visit(b.load), visit(b.grip), visit(b.lost_support);
  visit(b.awake), visit(b.lost), visit(b.touching), visit(b.has_touched);
}

template <typename Struct, typename Visit, IfIs<Struct, Collider> = 0>
void each_field(Struct& c, Visit&& visit) {
  visit(c.body), visit(c.part), visit(c.piece), visit(c.first_corner), visit(c.box);
}

template <typename Struct, typename Visit, IfIs<Struct, GjkCache> = 0>
void each_field(Struct& c, Visit&& visit) {
  visit(c.a), visit(c.b), visit(c.size);
}

template <typename Struct, typename Visit, IfIs<Struct, ContactPoint> = 0>
void each_field(Struct& p, Visit&& visit) {
  visit(p.from_a), visit(p.from_b), visit(p.local_a), visit(p.local_b);
  visit(p.separation), visit(p.found_separation), visit(p.normal_impulse);
}

template <typename Struct, typename Visit, IfIs<Struct, Pair> = 0>
void each_field(Struct& p, Visit&& visit) {
  visit(p.collider_a), visit(p.collider_b), visit(p.body_a), visit(p.body_b), visit(p.live);
  visit(p.apart_until), visit(p.searched_until), visit(p.order);
}

template <typename Struct, typename Visit, IfIs<Struct, ContactPoints> = 0>
void each_field(Struct& p, Visit&& visit) {
  bool made = p.made();
  visit(made);
  if constexpr (!std::is_const_v<Struct>) {
    if (made) p.make();
  }
  for (auto& point : p) visit(point);
}

template <typename Struct, typename Visit, IfIs<Struct, Contact> = 0>
void each_field(Struct& c, Visit&& visit) {
  visit(c.body_a), visit(c.body_b), visit(c.friction);
  visit(c.count), visit(c.points), visit(c.normal), visit(c.has_normal), visit(c.way_out);
  visit(c.friction_impulse), visit(c.twist_impulse), visit(c.pressed), visit(c.rest_pressed);
  visit(c.most), visit(c.highest), visit(c.rolls_a), visit(c.rolls_b);
  visit(c.cache);
}

template <typename Struct, typename Visit, IfIs<Struct, BroadPhase> = 0>
void each_field(Struct& broad, Visit&& visit) {
  BroadPhase::each_field(broad, visit);
}

template <typename Struct, typename Visit, IfIs<Struct, TreeMotor> = 0>
void each_field(Struct& m, Visit&& visit) {
  visit(m.on), visit(m.stiffness), visit(m.damping), visit(m.position), visit(m.speed);
  visit(m.torque), visit(m.effort), visit(m.speed_limit), visit(m.impulse), visit(m.mean);
  visit(m.work);
}

template <typename Struct, typename Visit, IfIs<Struct, LinkLoads> = 0>
void each_field(Struct& l, Visit&& visit) {
  visit(l.contact_force), visit(l.contact_moment), visit(l.joint_force), visit(l.joint_moment);
}

template <typename Struct, typename Visit, IfIs<Struct, TreeLink> = 0>
void each_field(Struct& l, Visit&& visit) {
  visit(l.body), visit(l.parent), visit(l.mobility), visit(l.first_q), visit(l.first_u);
  visit(l.parent_from_joint), visit(l.link_from_joint), visit(l.stiffness), visit(l.damping), visit(l.friction);
  visit(l.yield), visit(l.break_force), visit(l.break_torque), visit(l.lower), visit(l.upper);
  visit(l.collide), visit(l.rest), visit(l.rest_rotation), visit(l.friction_impulse), visit(l.linear), visit(l.angular);
  visit(l.motor), visit(l.belt_axis), visit(l.belt_speed), visit(l.eversion_axis), visit(l.loads);
  visit(l.wrinkling), visit(l.wrinkles_with);
}

template <typename Struct, typename Visit, IfIs<Struct, TreeLoop> = 0>
void each_field(Struct& l, Visit&& visit) {
  visit(l.link_a), visit(l.link_b), visit(l.mobility), visit(l.a_from_joint);
  visit(l.b_from_joint), visit(l.break_force), visit(l.break_torque), visit(l.collide);
  visit(l.force_impulse), visit(l.torque_impulse), visit(l.broken);
}

template <typename Struct, typename Visit, IfIs<Struct, Tree> = 0>
void each_field(Struct& t, Visit&& visit) {
  visit(t.links), visit(t.loops), visit(t.q_count), visit(t.u_count), visit(t.mass), visit(t.root);
  visit(t.driven), visit(t.tube);
}

template <typename Struct, typename Visit, IfIs<Struct, TreeState> = 0>
void each_field(Struct& s, Visit&& visit) {
  visit(s.q), visit(s.u);
}

template <typename Struct, typename Visit, IfIs<Struct, WorldRobot> = 0>
void each_field(Struct& r, Visit&& visit) {
  visit(r.tree), visit(r.first_body), visit(r.laid), visit(r.reached), visit(r.curve_left);
  visit(r.curve_up);
}

template <typename Struct, typename Visit, IfIs<Struct, RigidGroup> = 0>
void each_field(Struct& g, Visit&& visit) {
  visit(g.members), visit(g.reach);
}

template <typename Struct, typename Visit, IfIs<Struct, TieState> = 0>
void each_field(Struct& t, Visit&& visit) {
  visit(t.piece_a), visit(t.piece_b), visit(t.anchor_a), visit(t.anchor_b), visit(t.length);
  visit(t.strength), visit(t.stretch), visit(t.bending);
}

template <typename Struct, typename Visit, IfIs<Struct, Tie> = 0>
void each_field(Struct& t, Visit&& visit) {
  visit(t.state), visit(t.contact), visit(t.order), visit(t.solved);
}

template <typename Struct, typename Visit, IfIs<Struct, WorldData> = 0>
void each_field(Struct& d, Visit&& visit) {
  visit(d.bodies), visit(d.colliders), visit(d.corners), visit(d.broad), visit(d.pairs);
  visit(d.contacts);
  visit(d.contact_of_pair), visit(d.wake_next), visit(d.trees), visit(d.groups), visit(d.steps);
  visit(d.verification_steps), visit(d.all_awake_since), visit(d.lost);
  visit(d.verification_limit), visit(d.undamped_since), visit(d.undamped_tries);
  visit(d.robots), visit(d.ties), visit(d.tie_energy);
}

template <typename Struct, typename Visit, IfIs<Struct, FreeBody> = 0>
void each_field(Struct& f, Visit&& visit) {
  visit(f.mass), visit(f.inertia), visit(f.world_from_com), visit(f.linear_velocity);
  visit(f.angular_velocity);
}

template <typename Struct, typename Visit, IfIs<Struct, World::Snapshot> = 0>
void each_field(Struct& s, Visit&& visit) {
  visit(s.types), visit(s.data), visit(s.free), visit(s.block_starts);
  visit(s.tree_states);
}

}  // namespace rubble
