// What an impact may do at most, and what is damped; see kernel/solver/speed_limits.h.
#include "kernel/solver/speed_limits.h"

#include <algorithm>
#include <cmath>

#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

constexpr std::int32_t kNobody = -2;   // nothing touches the piece; see clamp_ejection_velocity()
constexpr std::int32_t kSeveral = -3;  // several pieces touch the piece
constexpr std::uint8_t kTouches = 0;   // find_rolling(): nothing is known of the piece yet
constexpr std::uint8_t kRolls = 1;     // find_rolling(): the piece rolls at its contacts
constexpr std::uint8_t kPushed = 2;    // find_rolling(): the piece also has a contact where it does not roll

}  // namespace

// What a piece loses goes back to the only one that touches it, if that is as heavy: where two
// meet, momentum is kept. With several, the one that squeezes is not known.
void World::Impl::return_clamped_momentum(std::size_t piece, const Vec3f& speed) {
  const std::int32_t other = neighbour[piece];
  if (other < 0) return;
  const Body &light = data.bodies[piece], &heavy = data.bodies[other];
  if (!heavy.awake || heavy.simbody_index < 0 || heavy.mass < light.mass) return;
  const Vec3f change = speed * float(light.mass / heavy.mass);
  velocities[other].linear += change;
  displacements[other].linear += change * float(options.step);
}

// A piece squeezed out from under a heavy one must not shoot away: sideways and upwards it may
// become hardly faster in one step than the points which touch it were before. Nor must what lies on the ground be
// shot through it: it moves down no faster than its own points or what strikes it did.
void World::Impl::clamp_ejection_velocity() {
  const auto outwards = [](const Vec3f& v) { return Vec3f{v.x, v.y, std::max(v.z, 0.0F)}; };
  const auto may_kick = [&](const Body& body) {
    return body.awake && body.touching && body.simbody_index >= 0;
  };
  const auto speed_before = [&](const Body& body) {
    return norm(outwards(body.linear)) + float(options.gravity * options.step);
  };
  const auto sinking_before = [&](const Body& body) {
    return std::max(-body.linear.z, 0.0F) + norm(body.angular) * float(body.radius) +
           float(options.gravity * options.step);
  };
  const bool any = std::any_of(awake_bodies.begin(), awake_bodies.end(), [&](std::int32_t i) {
    const Body& body = data.bodies[i];
    return may_kick(body) &&
           (norm(outwards(velocities[i].linear)) > std::max(speed_before(body), kFreeKick) ||
            -velocities[i].linear.z > sinking_before(body) + kFreeKick);
  });
  if (!any) return;
  fastest.assign(data.bodies.size(), 0);
  std::vector<std::uint8_t> on_ground(data.bodies.size(), 0);
  neighbour.assign(data.bodies.size(), kNobody);
  const auto note = [this](std::int32_t body, std::int32_t other) {
    if (body == kGround) return;
    neighbour[body] = neighbour[body] == kNobody || neighbour[body] == other ? other : kSeveral;
  };
  each_solved([&](const Contact& contact) {
    if (contact.pressed <= 0) return;
    note(contact.body_a, contact.body_b);
    note(contact.body_b, contact.body_a);
    if (contact.body_b == kGround) {
      on_ground[contact.body_a] = 1;
      return;
    }
    const Body &a = data.bodies[contact.body_a], &b = data.bodies[contact.body_b];
    float &of_a = fastest[contact.body_a], &of_b = fastest[contact.body_b];
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint& p = contact.points[i];
      of_a = std::max(of_a, norm(b.linear + cross(b.angular, p.from_b)));
      of_b = std::max(of_b, norm(a.linear + cross(a.angular, p.from_a)));
    }
  });
  for (std::int32_t i : awake_bodies) {
    if (!may_kick(data.bodies[i])) continue;
    const float down = -velocities[i].linear.z;
    const float most_down = std::max(sinking_before(data.bodies[i]), fastest[i]) + kFreeKick;
    if (on_ground[i] != 0 && down > most_down) {
      velocities[i].linear.z *= most_down / down, displacements[i].linear.z *= most_down / down;
    }
    const float after = norm(outwards(velocities[i].linear));
    const float before = speed_before(data.bodies[i]);
    const float squeezed = std::max(before, kKickShare * fastest[i]) + kFreeKick;
    const float struck = fastest[i] + kFreeKick;  // one neighbour alone cannot squeeze
    const float most =
        std::max(before, neighbour[i] == kSeveral ? std::min(squeezed, struck) : struck);
    if (after <= most) continue;
    const float keep = most / after;
    return_clamped_momentum(i, outwards(velocities[i].linear) * (1 - keep));
    for (Vec3f* v : {&velocities[i].linear, &displacements[i].linear}) {
      v->x *= keep, v->y *= keep;
      if (v->z > 0) v->z *= keep;
    }
  }
}

// 0 while a verification of rest may yet succeed by itself, 1 when it has lasted too long.
float World::Impl::calc_lateness() const {
  const float seconds = float(data.verification_steps) * float(options.step);
  return std::clamp((seconds - kPatience) / (kPatienceEnds - kPatience), 0.0F, 1.0F);
}

// The share of its spin that a piece keeps in a step of a verification that lasts. spin: its
// length.
float World::Impl::keep_of_late_spin(const Body& body, const Vec3f& angular, float spin) const {
  if (spin <= 0) return 1;
  const Vec3f axis = angular * (1 / spin);
  const float torque = kRollingLever * float(body.mass * options.gravity);
  const float stopped = torque * dot(axis, body.inverse_inertia * axis) * float(options.step);
  return std::max(0.0F, 1 - lateness * (kLateDamping + stopped / spin));
}

// How fast contacts may turn a piece in this step; unit: rad/s.
float World::Impl::calc_most_spin(const Body& body) {
  return std::max(kFreeSpin, norm(body.angular) + kSpinGain);
}

// What rolls is pushed where it is, however fast it turns.
void World::Impl::find_rolling() {
  rolling.assign(data.bodies.size(), kTouches);
  const auto note = [this](std::int32_t body, bool rolls, bool pressed) {
    if (body == kGround) return;
    if (rolls && rolling[body] == kTouches) rolling[body] = kRolls;
    if (pressed && !rolls) rolling[body] = kPushed;
  };
  each_solved([&note](const Contact& contact) {
    note(contact.body_a, contact.rolls_a, contact.pressed > 0);
    note(contact.body_b, contact.rolls_b, contact.pressed > 0);
  });
}

bool World::Impl::does_roll(std::size_t index) const { return rolling[index] == kRolls; }

}  // namespace rubble
