#include "kernel/world/world_diagnostics.h"

#include <algorithm>

#include "kernel/multibody/springs/tree_springs.h"
#include "kernel/world/world_impl.h"

namespace rubble {

World::Diagnostics World::diagnostics() { return Diagnostics(*impl_); }
const World::Diagnostics World::diagnostics() const { return Diagnostics(*impl_); }

DeepestOverlap World::Diagnostics::deepest_overlap() const {
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

bool World::Diagnostics::all_have_touched() const {
  for (const Body& body : impl_->data.bodies) {
    if (body.movable() && !body.has_touched) return false;
  }
  return true;
}

double World::Diagnostics::highest_point(bool touched_only) const {
  double top = 0;
  for (const Body& body : impl_->data.bodies) {
    if (body.lost || (touched_only && body.mass > 0 && !body.has_touched)) continue;
    impl_->bodies.each_collider(body, [&](int i) { top = std::max(top, impl_->data.colliders[i].box.max.z); });
  }
  return top;
}

double World::Diagnostics::kinetic_energy() const {
  double sum = 0;
  for (const Body& body : impl_->data.bodies) {
    if (!body.movable()) continue;
    const Vec3 v = impl_->bodies.linear_velocity(body);
    const Vec3 w = body.world_from_com.rotation.conjugate().rotate(impl_->bodies.angular_velocity(body));
    sum += 0.5 * (body.mass * dot(v, v) + dot(w, body.inertia * w));
  }
  return sum;
}

double World::Diagnostics::potential_energy() const {
  double sum = 0;
  for (const Body& body : impl_->data.bodies) {
    if (body.movable()) sum += body.mass * impl_->settings.options.gravity * body.world_from_com.translation.z;
  }
  for (std::size_t i = 0; i < impl_->data.trees.size(); ++i) {
    sum += calc_spring_energy(impl_->data.trees[i], impl_->simbody_trees.state(int(i)).q);
  }
  return sum;
}

Vec3 World::Diagnostics::linear_momentum() const {
  Vec3 sum;
  for (const Body& body : impl_->data.bodies) {
    if (body.movable()) sum += impl_->bodies.linear_velocity(body) * body.mass;
  }
  return sum;
}

Vec3 World::Diagnostics::angular_momentum() const {
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

SweepFigures World::Diagnostics::plan_sweeps(int threads) const { return impl_->solution.plan_sweeps(threads); }

void World::Diagnostics::set_on_stage(std::function<void(StepStage)> on_stage) { impl_->on_stage = std::move(on_stage); }

}  // namespace rubble
