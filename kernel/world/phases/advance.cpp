#include "kernel/world/phases/advance.h"

#include "kernel/multibody/free_bodies.h"
#include "kernel/solver/speed_limits.h"

namespace rubble {

BodyRates Advance::find_rates(std::size_t index, const StepMotions& motions, const ContactSolution& solution,
                              const SpeedLimiter& limits) const {
  const Body& body = data_.bodies[index];
  BodyRates r;
  if (body.touching || solution.has_intervened(std::int32_t(index))) {
    Motion m = motions.velocities[index];
    const float spin = norm(m.angular);
    const float most = SpeedLimiter::calc_most_spin(body);
    if (spin > most && !SpeedLimiter::does_roll(index, motions)) m.angular *= most / spin;
    if (motions.lateness > 0 && spin < kSwingingSpin) {
      m.angular *= limits.keep_of_late_spin(body, m.angular, spin, motions.lateness);
    }
    r.linear = Vec3(m.linear), r.angular = Vec3(m.angular);
    const double per_step = 1 / settings_.options.step;
    r.extra_linear = Vec3(motions.displacements[index].linear) * per_step - r.linear;
    r.extra_angular = Vec3(motions.displacements[index].angular) * per_step - r.angular;
  } else {
    // Nothing touches it: the exact parabola and free rotation, in double precision.
    const FreeRotation free =
        rotate_freely(body.world_from_com.rotation, body.inertia, blocks_.angular_velocity(body.free_index),
                      settings_.options.step);
    r.linear = blocks_.linear_velocity(body.free_index);
    r.linear.z -= settings_.options.gravity * settings_.options.step;
    r.extra_linear = {0, 0, 0.5 * settings_.options.gravity * settings_.options.step};
    r.angular = free.angular;
    r.turns_freely = true;
    r.rotation = free.rotation;
  }
  return r;
}

// How far any point of a body can have gone in the step.
double Advance::calc_travel(const Body& body, const BodyRates& r) const {
  return settings_.options.step *
         (norm(r.linear + r.extra_linear) + norm(r.angular + r.extra_angular) * double(body.radius));
}

// Those that were added together, one after the other: neighbours in height.
void Advance::list_blocks(const StepPairs& step) {
  moves_.assign(std::size_t(blocks_.size()), 0);
  block_awake_.assign(std::size_t(blocks_.block_count()), 0);
  body_of_.resize(std::size_t(blocks_.size()));
  for (std::int32_t i : step.awake) {
    const Body& body = data_.bodies[i];
    if (body.free_index < 0) continue;
    moves_[body.free_index] = 1;
    body_of_[body.free_index] = i;
    block_awake_[blocks_.block_of_body(body.free_index)] = 1;
  }
}

void Advance::run(const StepPairs& step, const StepMotions& motions, const ContactSolution& solution,
                  const SpeedLimiter& limits) {
  list_blocks(step);
  const auto move = [&](int mobile) {
    const std::int32_t index = body_of_[mobile];
    Body& body = data_.bodies[index];
    const BodyRates rates = find_rates(std::size_t(index), motions, solution, limits);
    blocks_.advance(mobile, rates, settings_.options.step);
    body.travel += calc_travel(body, rates);
    bodies_.mirror(body);
    bodies_.refresh(body);
  };
  pool_.run(blocks_.block_count(), 4, [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      if (!block_awake_[block]) continue;
      const int last = blocks_.first_of(block + 1);
      for (int mobile = blocks_.first_of(block); mobile < last; ++mobile) {
        if (moves_[mobile]) move(mobile);
      }
    }
  });
}

}  // namespace rubble
