// Impulses from outside: how a piece answers to one.
#include "kernel/base/inertia.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

// Of the angular velocity, by a moment in the world.
Mat3 inverse_inertia(const Body& body) {
  const Mat3 turn = body.world_from_com.rotation.matrix();
  return turn * inverse_of(body.inertia) * turn.transposed();
}

}  // namespace

void World::apply_impulse(int index, const Vec3& point, const Vec3& impulse) {
  Body& body = impl_->bodies.acting(index);
  if (!body.movable()) return;
  impl_->waking.wake(int(&body - impl_->data.bodies.data()));
  if (body.tree >= 0) return impl_->trees.apply_impulse(index, point, impulse);
  const Vec3 moment = cross(point - body.world_from_com.translation, impulse);
  impl_->blocks.set_velocity(body.free_index, impl_->bodies.linear_velocity(body) + impulse * (1 / body.mass),
                             impl_->bodies.angular_velocity(body) + inverse_inertia(body) * moment);
  impl_->bodies.mirror(body);
}

Mat3 World::impulse_response(int index, const Vec3& point) const {
  const Body& body = impl_->bodies.acting(index);
  Mat3 response{};
  if (!body.movable()) return response;
  if (body.tree >= 0) return impl_->trees.impulse_response(index, point);
  const Mat3 inverse = inverse_inertia(body);
  const Vec3 arm = point - body.world_from_com.translation;
  for (int k = 0; k < 3; ++k) {
    Vec3 unit;
    unit[k] = 1;
    const Vec3 gained = unit * (1 / body.mass) + cross(inverse * cross(arm, unit), arm);
    for (int row = 0; row < 3; ++row) response.rows[row][k] = gained[row];
  }
  return response;
}

}  // namespace rubble
