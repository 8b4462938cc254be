// Data that the phases of a step exchange. World::step() in world_step.cpp has their order. Not for use outside kernel/.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"
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

// What phases ask of all contacts after the solution, so that none has to look at each of these, which are far apart in memory.
struct SolvedContact {
  std::int32_t body_a = 0, body_b = 0;     // the second may be kGround
  std::int32_t index = 0;                  // in WorldData::contacts
  bool pressed = false;                    // carries an impulse
  bool rolls_a = false, rolls_b = false;   // as Contact has them
  bool at_sleeper = false;                 // a body was asleep when the step began
};

// Bodies and pairs of a step. PairSelection makes them, Sleep::wake_hit() adds woken ones, ContactSearch marks overlaps,
// and Solution sorts. They are kept until the next step.
struct StepPairs {
  std::vector<std::int32_t> awake;         // bodies, ascending
  std::vector<StepMotion> sweeps;          // by body
  std::vector<std::int32_t> active;        // pairs with an awake body that may touch
  std::vector<std::uint8_t> is_deep;       // by pair: overlap deeper than sleep allows
  std::vector<std::uint8_t> may_be_stuck;  // by pair: is_stuck(), or was separated by a way out before
  std::vector<SolvedContact> solved;       // of the active pairs, in their order

  void list_awake(const std::vector<Body>& bodies);
  void note_solved(const std::vector<Contact>& contacts, ThreadPool& pool);
  SolvedContact facts_of(const Contact& contact, std::int32_t index) const;
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

// The same by what is known of them. action(facts, get): get() gives the contact.
template <typename Data, typename Action>
void each_solved_fact(Data& data, const StepPairs& pairs, Action&& action) {
  for (const SolvedContact& facts : pairs.solved) action(facts, [&]() -> auto& { return data.contacts[facts.index]; });
  for (auto& tie : data.ties) {
    if (tie.solved) action(pairs.facts_of(tie.contact, 0), [&]() -> auto& { return tie.contact; });
  }
}

// The indices i from 0 to count - 1 for which is_wanted(i), ascending.
class WantedList {
 public:
  template <typename IsWanted>
  const std::vector<std::int32_t>& find(int count, ThreadPool& pool, const IsWanted& is_wanted) {
    constexpr int kChunk = 2048;  // that one job looks at: far more work than to hand it out; unit: 1
    const std::size_t chunks = std::size_t((count + kChunk - 1) / kChunk);
    if (parts_.size() < chunks) parts_.resize(chunks);
    pool.run(int(chunks), 1, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        parts_[k].clear();
        for (int i = k * kChunk; i < std::min(count, (k + 1) * kChunk); ++i) {
          if (is_wanted(i)) parts_[k].push_back(i);
        }
      }
    });
    list_.clear();
    for (std::size_t k = 0; k < chunks; ++k) list_.insert(list_.end(), parts_[k].begin(), parts_[k].end());
    return list_;
  }

 private:
  std::vector<std::vector<std::int32_t>> parts_;
  std::vector<std::int32_t> list_;
};

}  // namespace rubble
