// What an impact may do at most, and what is damped; see kernel/solver/speed_limits.h.
#include "kernel/world/phases/speed_limiter.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "kernel/solver/speed_limits.h"

namespace rubble {
namespace {

constexpr std::int32_t kNobody = -2;   // nothing touches the piece; see clamp_ejections()
constexpr std::int32_t kSeveral = -3;  // several pieces touch the piece
constexpr std::uint8_t kTouches = 0;   // find_rolling(): nothing is known of the piece yet
constexpr std::uint8_t kRolls = 1;     // find_rolling(): the piece rolls at its contacts
constexpr std::uint8_t kPushed = 2;    // find_rolling(): the piece also has a contact where it does not roll

// Momentum that comes back to a piece may throw it this fast; unit: m/s.
constexpr float kThrownBack = 12;

constexpr float kNotAsked = -1;            // find_strikes(): the piece does not spin fast; unit: m/s

Vec3f outwards(const Vec3f& v) { return {v.x, v.y, std::max(v.z, 0.0F)}; }

// How far a velocity lies beyond those that pushes by what moves at `striker` can give a piece: see kFreeKick. Nothing
// is beyond that leads downwards.
Vec3f find_excess(Vec3f velocity, const Vec3f& start, const Vec3f& striker) {
  velocity.z = std::max(velocity.z, std::min({start.z, striker.z, 0.0F}));
  const Vec3f from_middle = velocity - (start + striker) * 0.5F;
  const float radius = 0.5F * norm(striker - start) + kFreeKick, distance = norm(from_middle);
  if (distance <= radius) return {};
  const Vec3f excess = from_middle * (1 - radius / distance);
  return {excess.x, excess.y, std::max(excess.z, 0.0F)};
}

}  // namespace

// What a piece loses goes back to the only one that touches it, if that is as heavy: where two
// meet, momentum is kept. With several, the one that squeezes is not known.
void SpeedLimiter::return_momentum(std::size_t piece, const Vec3f& speed, StepMotions& motions) {
  const std::int32_t other = neighbour_[piece];
  if (other < 0) return;
  const Body &light = data_.bodies[piece], &heavy = data_.bodies[other];
  if (!heavy.awake || heavy.free_index < 0 || heavy.mass < light.mass) return;
  const Vec3f change = speed * float(light.mass / heavy.mass);
  motions.velocities[other].linear += change;
  motions.displacements[other].linear += change * float(settings_.options.step);
  given_back_.push_back(other);
}

bool SpeedLimiter::may_kick(const Body& body) const { return body.awake && body.touching && body.free_index >= 0; }

float SpeedLimiter::speed_before(const Body& body) const {
  return norm(outwards(body.linear)) + float(settings_.options.gravity * settings_.options.step);
}

float SpeedLimiter::sinking_before(const Body& body) const {
  return std::max(-body.linear.z, 0.0F) + norm(body.angular) * float(body.radius) +
         float(settings_.options.gravity * settings_.options.step);
}

// Those that may have to be clamped. False: none goes so fast that it matters.
bool SpeedLimiter::find_kicked(const StepPairs& step, const StepMotions& motions) {
  std::atomic<bool> any{false};
  kicked_.assign(data_.bodies.size(), 0);
  pool_.run(int(step.awake.size()), 128, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::int32_t i = step.awake[k];
      const Body& body = data_.bodies[i];
      if (!may_kick(body)) continue;
      const Vec3f& velocity = motions.velocities[i].linear;
      const float after = norm(outwards(velocity)), before = speed_before(body);
      const bool sinks = -velocity.z > sinking_before(body) + kFreeKick;
      if (after > before || sinks) kicked_[i] = 1;
      if (after > std::max(before, kFreeKick) || sinks) any = true;
    }
  });
  return any;
}

// Finds what touches them, and what these touch.
void SpeedLimiter::look_around_kicked(const StepPairs& step) {
  each_solved_fact(data_, step, [this](const SolvedContact& contact, const auto&) {
    if (!contact.pressed || contact.body_b == kGround) return;
    std::uint8_t &a = kicked_[contact.body_a], &b = kicked_[contact.body_b];
    if (a == 1 && b == 0) b = 2;
    if (b == 1 && a == 0) a = 2;
  });
  fastest_.assign(data_.bodies.size(), 0);
  strikers_.assign(data_.bodies.size(), {});
  on_ground_.assign(data_.bodies.size(), 0);
  neighbour_.assign(data_.bodies.size(), kNobody);
  const auto note = [this](std::int32_t body, std::int32_t other) {
    if (body == kGround) return;
    neighbour_[body] = neighbour_[body] == kNobody || neighbour_[body] == other ? other : kSeveral;
  };
  const auto note_speed = [this](std::int32_t body, const Vec3f& velocity) {
    const float speed = norm(velocity);
    if (speed > fastest_[body]) fastest_[body] = speed, strikers_[body] = velocity;
  };
  each_solved_fact(data_, step, [&](const SolvedContact& facts, const auto& get) {
    const bool on_ground = facts.body_b == kGround;
    if (!facts.pressed || (kicked_[facts.body_a] == 0 && (on_ground || kicked_[facts.body_b] == 0))) return;
    note(facts.body_a, facts.body_b);
    note(facts.body_b, facts.body_a);
    if (on_ground) {
      on_ground_[facts.body_a] = 1;
      return;
    }
    const Body &a = data_.bodies[facts.body_a], &b = data_.bodies[facts.body_b];
    const Contact& contact = get();
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint& p = contact.points[i];
      note_speed(facts.body_a, b.linear + cross(b.angular, p.from_b));
      note_speed(facts.body_b, a.linear + cross(a.angular, p.from_a));
    }
  });
}

// How far a piece goes sideways and upwards beyond what its own motion before or what strikes it explains.
Vec3f SpeedLimiter::find_beyond(std::int32_t i, const StepMotions& motions) const {
  const Body& body = data_.bodies[i];
  const float before = speed_before(body);
  const Vec3f& velocity = motions.velocities[i].linear;
  const float after = norm(outwards(velocity));
  if (after <= before) return {};
  Vec3f excess = outwards(velocity) * (1 - before / after);
  const auto allow_from = [&](const Vec3f& start) {
    const Vec3f beyond = find_excess(velocity, start, strikers_[i]);
    if (norm(beyond) < norm(excess)) excess = beyond;
  };
  allow_from({});
  if (neighbour_[i] != kSeveral) allow_from(body.linear);
  return excess;
}

void SpeedLimiter::clamp(std::int32_t i, StepMotions& motions) {
  const Body& body = data_.bodies[i];
  const float down = -motions.velocities[i].linear.z;
  const float most_down = std::max(sinking_before(body), fastest_[i]) + kFreeKick;
  if (on_ground_[i] != 0 && down > most_down) {
    motions.velocities[i].linear.z *= most_down / down, motions.displacements[i].linear.z *= most_down / down;
  }
  const Vec3f excess = find_beyond(i, motions);
  if (norm(excess) <= 0) return;
  return_momentum(i, excess, motions);
  slow_down(i, excess, motions);
}

void SpeedLimiter::slow_down(std::int32_t i, const Vec3f& excess, StepMotions& motions) const {
  motions.velocities[i].linear -= excess;
  motions.displacements[i].linear -= excess * float(settings_.options.step);
}

void SpeedLimiter::clamp_ejections(const StepPairs& step, StepMotions& motions) {
  if (!find_kicked(step, motions)) return;
  look_around_kicked(step);
  given_back_.clear();
  for (std::int32_t i : step.awake) {
    if (kicked_[i] != 0 && may_kick(data_.bodies[i])) clamp(i, motions);
  }
  // A piece that was thrown itself may have been clamped before the momentum of another came back to it: a sleeper that
  // wakes under what a slab pressed on it with throws its neighbour, and would be shot away in its place.
  for (const std::int32_t i : given_back_) {
    const Vec3f beyond = find_beyond(i, motions);
    if (norm(beyond) > kThrownBack) slow_down(i, beyond, motions);
  }
}

float SpeedLimiter::calc_lateness() const {
  if (data_.undamped_since >= 0) return 0;
  const float seconds = float(data_.verification_steps) * float(settings_.options.step);
  return std::clamp((seconds - kPatience) / (kPatienceEnds - kPatience), 0.0F, 1.0F);
}

float SpeedLimiter::keep_of_late_spin(const Body& body, const Vec3f& angular, float spin,
                                      float lateness) const {
  if (spin <= 0) return 1;
  const Vec3f axis = angular * (1 / spin);
  const float torque = kRollingLever * float(body.mass * settings_.options.gravity);
  const float stopped = torque * dot(axis, body.inverse_inertia * axis) * float(settings_.options.step);
  return std::max(0.0F, 1 - lateness * (kLateDamping + stopped / spin));
}

float SpeedLimiter::calc_most_spin(std::int32_t body) const {
  const Body& of = data_.bodies[body];
  const float struck = strikes_.empty() || strikes_[body] < kHardStrike ? 0 : strikes_[body] / of.radius;
  return std::max({kFreeSpin, norm(of.angular) + kSpinGain, struck});
}

void SpeedLimiter::find_strikes(const StepPairs& step, const StepMotions& motions) {
  strikes_.clear();
  const std::vector<std::int32_t>& spinning = wanted_.find(
      int(step.awake.size()), pool_, [&](int k) { return norm(motions.velocities[step.awake[k]].angular) > kFreeSpin; });
  if (spinning.empty()) return;
  strikes_.assign(data_.bodies.size(), kNotAsked);
  for (const std::int32_t k : spinning) strikes_[step.awake[k]] = 0;
  const auto spins = [this](std::int32_t body) { return body != kGround && strikes_[body] != kNotAsked; };
  const auto velocity_at = [this](std::int32_t body, const Vec3f& arm) {
    return body == kGround ? Vec3f{} : data_.bodies[body].linear + cross(data_.bodies[body].angular, arm);
  };
  each_solved_fact(data_, step, [&](const SolvedContact& facts, const auto& get) {
    if (!facts.pressed || (!spins(facts.body_a) && !spins(facts.body_b))) return;
    const Contact& contact = get();
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint& p = contact.points[i];
      const float closing = dot(contact.normal, velocity_at(contact.body_a, p.from_a) - velocity_at(contact.body_b, p.from_b));
      for (const std::int32_t body : {contact.body_a, contact.body_b}) {
        if (spins(body)) strikes_[body] = std::max(strikes_[body], closing);
      }
    }
  });
}

void SpeedLimiter::find_rolling(const StepPairs& step, StepMotions& motions) {
  motions.rolls.assign(data_.bodies.size(), kTouches);
  const auto note = [&motions](std::int32_t body, bool rolls, bool pressed) {
    if (body == kGround) return;
    if (rolls && motions.rolls[body] == kTouches) motions.rolls[body] = kRolls;
    if (pressed && !rolls) motions.rolls[body] = kPushed;
  };
  each_solved_fact(data_, step, [&note](const SolvedContact& contact, const auto&) {
    note(contact.body_a, contact.rolls_a, contact.pressed);
    note(contact.body_b, contact.rolls_b, contact.pressed);
  });
}

bool SpeedLimiter::does_roll(std::size_t body, const StepMotions& motions) {
  return motions.rolls[body] == kRolls;
}

}  // namespace rubble
