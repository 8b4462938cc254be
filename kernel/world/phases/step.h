// Data that the phases of a step exchange. World::step() in world_step.cpp has their order. Not for use outside kernel/.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/world/state/world_data.h"

namespace rubble {

// Input of the search for pairs: read for every piece in every step, so it is compact. Only `travel` is set for sleeping
// pieces.
struct StepMotion {
  Vec3f linear;       // unit: m/s
  float turning = 0;  // angular speed times radius; unit: m/s
  float reach = 0;    // no point goes farther in this step; unit: m
  double travel = 0;  // as Body::travel; unit: m
  bool awake = false;
};

// Bodies and pairs of a step. PairSelection makes them, Sleep::wake_hit() adds woken ones, ContactSearch marks overlaps,
// and Solution sorts. They are kept until the next step.
struct StepPairs {
  std::vector<std::int32_t> awake;         // bodies, ascending
  std::vector<StepMotion> sweeps;          // by body
  std::vector<std::int32_t> active;        // pairs with an awake body that may touch
  std::vector<std::uint8_t> is_deep;       // by pair: overlap deeper than sleep allows
  std::vector<std::uint8_t> may_be_stuck;  // by pair: is_stuck(), or was separated by a way out before

  void list_awake(const std::vector<Body>& bodies);
  // Parts that are farther apart cannot touch in this step; body_b may be kGround. unit: m
  float calc_margin(int body_a, int body_b, const NarrowSettings& settings) const;
};

// Motions of bodies in a step: computed by Solution, limited by SpeedLimiter, applied by Advance.
struct StepMotions {
  std::vector<Motion> velocities;     // at the end of the step; by body
  std::vector<Motion> displacements;  // in the step; by body
  std::vector<std::uint8_t> rolls;    // by body: at all of its contacts, see SpeedLimiter::find_rolling()
  float lateness = 0;                 // see SpeedLimiter::calc_lateness()
};

// The contacts of the last solution, and the ties in it. Data: WorldData or const WorldData.
template <typename Data, typename Action>
void each_solved(Data& data, const StepPairs& pairs, Action&& action) {
  for (const std::int32_t index : pairs.active) action(data.contacts[index]);
  for (auto& tie : data.ties) {
    if (tie.solved) action(tie.contact);
  }
}

}  // namespace rubble
