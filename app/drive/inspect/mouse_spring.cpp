#include "app/drive/inspect/mouse_spring.h"

#include "kernel/base/inertia.h"
#include "kernel/base/portable_math.h"
#include "kernel/world/world_structures.h"

namespace rubble {
namespace {

constexpr double kGravity = 9.81;  // unit: m/s2

}  // namespace

bool MouseSpring::grab(const World& world, int piece, const Vec3& point) {
  held_.reset();
  if (piece < 0 || piece >= world.size()) return false;
  const PieceState state = world.piece(piece);
  if (state.status == PieceStatus::lost || state.status == PieceStatus::fixed) return false;
  Held held;
  held.piece = piece;
  held.in_body = state.world_from_body.inverse() * point;
  held.mass = world.mass(world.structures().bound_with(piece).front());
  if (!(held.mass > 0)) return false;
  held_ = held;
  target_ = point;
  return true;
}

Vec3 MouseSpring::point(const World& world) const {
  return world.piece(held_->piece).world_from_body * held_->in_body;
}

Vec3 MouseSpring::calc_impulse(const World& world, double h) const {
  const PieceState state = world.piece(held_->piece);
  const Vec3 at = point(world);
  const int lead = world.structures().bound_with(held_->piece).front();  // bodies break
  const Vec3 centre = world.piece(lead).world_from_body * world.centre_of_mass(lead);
  const Vec3 velocity = world.structures().centre_velocity(lead) + cross(state.angular_velocity, at - centre);
  const double omega = 2 * portable::kPi * options_.frequency;
  const double k = held_->mass * omega * omega, c = 2 * held_->mass * options_.damping * omega;
  const double soft = c + h * k;
  Mat3 response = world.impulse_response(held_->piece, at);
  for (int i = 0; i < 3; ++i) response.rows[i][i] += 1 / (h * soft);
  const Vec3 impulse = -(inverse_of(response) * (velocity + (at - target_) * (k / soft)));
  const double most = options_.most_force * held_->mass * kGravity * h, size = norm(impulse);
  return size > most ? impulse * (most / size) : impulse;
}

}  // namespace rubble
