// What acts on a building beside contacts: vehicles, ground that moves; and
// the energy that breaking took.
#include <algorithm>
#include <cmath>

#include "kernel/settling/collapse_impl.h"
#include "kernel/world/world_structures.h"

namespace rubble {
namespace {

constexpr double kStopped = 0.1;    // a vehicle this slow breaks nothing more; unit: m/s
constexpr double kStrikeTime = 3;   // after which it has stopped or passed; unit: s

double quiet_sqrt(double x) { return x > 0 ? std::sqrt(x) : 0; }

}  // namespace

// What is free is pushed where the vehicle has caught up with it, and takes no more than what makes both
// equally fast.
Vec3 Collapse::Impl::strike_force() const {
  if (struck < 0) return {};
  const int lead = first + lead_of[struck];
  double force = std::min(striker.force, striker.mass * striker.speed / options.step);
  if (is_free(lead)) {
    const Vec3 moved = world.piece(first + struck).world_from_body.translation - struck_from;
    if (dot(moved, striker.direction) > driven) return {};
    const double faster = striker.speed - dot(world.structures().centre_velocity(lead), striker.direction);
    const double mass = 1 / (1 / striker.mass + 1 / world.mass(lead));
    force = std::min(force, std::max(0.0, faster) * mass / options.step);
  }
  return striker.direction * force;
}

// A blow is over before the rest of the building can answer: where it is stronger than the sections around a
// piece are in shear, those fail and nothing else.
void Collapse::Impl::knock_out() {
  double strength = 0;
  std::vector<BondFailure> failures;
  for (std::size_t i = 0; i < structure.bonds.size(); ++i) {
    const Bond& bond = structure.bonds[i];
    if (status[i].broken || (bond.piece_a != struck && bond.piece_b != struck)) continue;
    strength += (bond.section.shear + bond.section.steel.stirrups) * bond.section.area;
    failures.push_back({std::int32_t(i), FailureMode::shear, false, 0, false});
  }
  if (failures.empty() || striker.force < strength) return;
  for (BondFailure& failure : failures) {
    failure.utilization = striker.force / strength;
    status[failure.bond].broken = true;
    ++report.broken;
  }
  tie(failures);
  const std::int32_t lead = lead_of[struck];
  if (parts.count(lead)) replace(lead, groups_left_of(lead));
}

void Collapse::Impl::strike() {
  if (struck < 0) return;
  const Vec3 force = strike_force();
  const int lead = first + lead_of[struck];
  if (is_free(lead)) {
    set_motion(lead, force * (options.step / world.mass(lead)), world.piece(lead).angular_velocity);
    driven += striker.speed * options.step;
  }
  striker.speed -= norm(force) * options.step / striker.mass;
  if (striker.speed <= kStopped || --strike_steps <= 0) struck = -1;
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

void Collapse::strike(int member, const Vec3& at, const Striker& striker) {
  Impl& c = *impl_;
  double nearest = 1e30;
  for (std::size_t i = 0; i < c.structure.pieces.size(); ++i) {
    const double away = distance(c.structure.pieces[i].centre, at);
    if (c.structure.pieces[i].member != member || away >= nearest) continue;
    c.struck = std::int32_t(i);
    nearest = away;
  }
  if (c.struck < 0) return;
  c.strike_at = at, c.striker = striker;
  c.struck_from = c.world.piece(c.first + c.struck).world_from_body.translation;
  c.strike_steps = int(kStrikeTime / c.options.step);
  c.knock_out();
}

}  // namespace rubble
