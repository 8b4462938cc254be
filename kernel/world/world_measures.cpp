// What can be measured of all pieces together: overlaps, energies, momenta, joints and impulses.
#include <algorithm>
#include <utility>

#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/springs/tree_springs.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

constexpr double kSubsteps = SolverSettings{}.substeps;

}  // namespace

DeepestOverlap World::deepest_overlap() const {
  DeepestOverlap deepest;
  for (std::size_t i = 0; i < impl_->data.pairs.size(); ++i) {
    if (!impl_->data.pairs[i].live) continue;
    const Contact& contact = impl_->data.contacts[i];
    for (int k = 0; k < contact.count; ++k) {
      const double depth = -double(contact.points[k].separation);
      if (depth > deepest.depth) deepest = {depth, contact.body_a, contact.body_b};
    }
  }
  return deepest;
}

bool World::all_have_touched() const {
  for (const Body& body : impl_->data.bodies) {
    if (body.movable() && !body.has_touched) return false;
  }
  return true;
}

double World::highest_point(bool touched_only) const {
  double top = 0;
  for (const Body& body : impl_->data.bodies) {
    if (body.lost || (touched_only && body.mass > 0 && !body.has_touched)) continue;
    impl_->bodies.each_collider(body, [&](int i) { top = std::max(top, impl_->data.colliders[i].box.max.z); });
  }
  return top;
}

double World::kinetic_energy() const {
  double sum = 0;
  for (const Body& body : impl_->data.bodies) {
    if (!body.movable()) continue;
    const Vec3 v = impl_->bodies.linear_velocity(body);
    const Vec3 w = body.world_from_com.rotation.conjugate().rotate(impl_->bodies.angular_velocity(body));
    sum += 0.5 * (body.mass * dot(v, v) + dot(w, body.inertia * w));
  }
  return sum;
}

double World::potential_energy() const {
  double sum = 0;
  for (const Body& body : impl_->data.bodies) {
    if (body.movable()) sum += body.mass * impl_->settings.options.gravity * body.world_from_com.translation.z;
  }
  for (std::size_t i = 0; i < impl_->data.trees.size(); ++i) {
    sum += calc_spring_energy(impl_->data.trees[i], impl_->simbody_trees.state(int(i)).q);
  }
  return sum;
}

Vec3 World::linear_momentum() const {
  Vec3 sum;
  for (const Body& body : impl_->data.bodies) {
    if (body.movable()) sum += impl_->bodies.linear_velocity(body) * body.mass;
  }
  return sum;
}

Vec3 World::angular_momentum() const {
  Vec3 sum;
  for (const Body& body : impl_->data.bodies) {
    if (!body.movable()) continue;
    const Quat& q = body.world_from_com.rotation;
    const Vec3 v = impl_->bodies.linear_velocity(body);
    const Vec3 w = q.conjugate().rotate(impl_->bodies.angular_velocity(body));
    sum += cross(body.world_from_com.translation, v * body.mass) + q.rotate(body.inertia * w);
  }
  return sum;
}

namespace {

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

}  // namespace

std::vector<ContactImpulse> World::contacts() const {
  const WorldData& data = impl_->data;
  std::vector<ContactImpulse> result;
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    if (!data.pairs[i].live || !(data.contacts[i].pressed > 0)) continue;
    each_contact_point(data, data.pairs[i], data.contacts[i], [&result](const ContactImpulse& c) {
      result.push_back(c.piece < 0 ? on_the_other(c) : c);
    });
  }
  return result;
}

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

std::vector<JointState> World::joints() const {
  const Impl& w = *impl_;
  std::vector<JointState> joints;
  for (const Tree& tree : w.data.trees) {
    for (const TreeLink& link : tree.links) {
      if (link.parent < 0) continue;
      JointState joint;
      joint.parent = tree.links[std::size_t(link.parent)].body;
      joint.child = link.body;
      joint.kind = kind_of(link.mobility);
      joint.parent_from_joint = Pose{{}, w.data.bodies[joint.parent].com_in_type} * link.parent_from_joint;
      joint.child_from_joint = Pose{{}, w.data.bodies[joint.child].com_in_type} * link.link_from_joint;
      joint.rest = link.rest;
      joint.rest_rotation = link.rest_rotation;
      joints.push_back(joint);
    }
    for (const TreeLoop& loop : tree.loops) {
      JointState joint;
      joint.parent = tree.links[std::size_t(loop.link_a)].body;
      joint.child = tree.links[std::size_t(loop.link_b)].body;
      joint.kind = kind_of(loop.mobility);
      joint.parent_from_joint = Pose{{}, w.data.bodies[joint.parent].com_in_type} * loop.a_from_joint;
      joint.child_from_joint = Pose{{}, w.data.bodies[joint.child].com_in_type} * loop.b_from_joint;
      joints.push_back(joint);
    }
  }
  // A piece hangs on one other at most; then come the joints that close loops, as they were made.
  std::stable_sort(joints.begin(), joints.end(),
                   [](const JointState& a, const JointState& b) { return a.child < b.child; });
  return joints;
}

}  // namespace rubble
