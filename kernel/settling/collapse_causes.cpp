// What acts on a building beside contacts: blasts, vehicles, sinking ground, ground that moves; and
// the energy that breaking took.
#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/settling/collapse_impl.h"

namespace rubble {
namespace {

double quiet_sqrt(double x) { return x > 0 ? std::sqrt(x) : 0; }

}  // namespace

// What a vehicle drives into, until it has come to a stop.
void Collapse::Impl::push_free() {
  if (push_steps <= 0) return;
  --push_steps;
  const int lead = first + lead_of[pushed];
  if (!is_free(lead)) return;
  set_motion(lead, push_force * (options.step / world.mass(lead)),
             world.piece(lead).angular_velocity);
}

void Collapse::Impl::drain() {
  std::map<int, double> energy;
  for (const auto& [piece, taken] : drained) energy[lead_in_world(piece)] += taken;
  drained.clear();
  for (const auto& [piece, taken] : energy) {
    const double mass = world.mass(piece);
    const PieceState state = world.piece(piece);
    const double has = 0.5 * mass * dot(state.linear_velocity, state.linear_velocity);
    if (!is_free(piece) || !(has > 0)) continue;
    const double keep = quiet_sqrt(1 - taken / has);
    set_motion(piece, state.linear_velocity * keep - state.linear_velocity,
               state.angular_velocity * keep);
  }
}

void Collapse::Impl::throw_blasted() {
  std::map<int, Vec3> impulses;
  for (const auto& [piece, impulse] : blasted) impulses[first + lead_of[piece]] += impulse;
  blasted.clear();
  for (const auto& [piece, impulse] : impulses) {
    if (is_free(piece)) {
      set_motion(piece, impulse * (1 / world.mass(piece)), world.piece(piece).angular_velocity);
    }
  }
}

// In the frame of the ground everything that is not held is accelerated against it.
void Collapse::Impl::accelerate() {
  if (dot(ground_acceleration, ground_acceleration) == 0) return;
  for (int i = 0; i < world.size(); ++i) {
    if (lead_in_world(i) != i || world.mass(i) <= 0) continue;
    set_motion(i, ground_acceleration * -options.step, world.piece(i).angular_velocity);
  }
}

void Collapse::blast(const Vec3& at, double impulse_at_1m) {
  for (std::size_t i = 0; i < impl_->structure.pieces.size(); ++i) {
    const StructurePiece& piece = impl_->structure.pieces[i];
    const double density = impl_->structure.types[piece.type].density;
    const Vec3 away = piece.centre - at;
    const double r = std::max(1.0, norm(away)), volume = piece.mass / density;
    const double area = portable::exp(2.0 / 3.0 * portable::log(volume));
    impl_->blasted[std::int32_t(i)] = normalized(away) * (impulse_at_1m * area / (r * r));
  }
}

void Collapse::push(int member, const Vec3& at, const Vec3& force, double seconds) {
  Impl& c = *impl_;
  double nearest = 1e30;
  for (std::size_t i = 0; i < c.structure.pieces.size(); ++i) {
    const double away = distance(c.structure.pieces[i].centre, at);
    if (c.structure.pieces[i].member != member || away >= nearest) continue;
    c.pushed = std::int32_t(i);
    nearest = away;
  }
  c.push_at = at, c.push_force = force;
  c.push_steps = c.pushed < 0 ? 0 : std::max(1, int(seconds / c.options.step + 0.5));
}

void Collapse::sink(int member, const Vec3& by) {
  for (std::size_t i = 0; i < impl_->structure.bonds.size(); ++i) {
    const Bond& bond = impl_->structure.bonds[i];
    if (bond.piece_b != kFoundation || impl_->structure.pieces[bond.piece_a].member != member)
      continue;
    impl_->status[i].sunk = by;
    impl_->sinks = true;
  }
}

}  // namespace rubble
