// First phase of a step: who is awake, and which pairs may touch. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/world/phases/step.h"
#include "kernel/world/state/pairs.h"

namespace rubble {

class PairSelection {
 public:
  PairSelection(WorldData& data, const WorldSettings& settings, const Bodies& bodies, Pairs& pairs,
                ThreadPool& pool)
      : data_(data), settings_(settings), bodies_(bodies), pairs_(pairs), pool_(pool) {}

  // Finds new pairs, drops those that are apart, and lists those with somebody awake that may touch in this
  // step: fills all of `step` but what overlaps. Pairs that wait lose their points.
  void run(StepPairs& step);

 private:
  void find_pairs(StepPairs& step);
  void select_pairs(StepPairs& step);
  void note_sweeps(StepPairs& step);
  Aabb calc_swept_box(int collider) const;
  void find_leaving(const StepPairs& step);
  void find_neighbours(int collider, std::vector<std::int32_t>& out) const;
  std::uint8_t classify(const StepPairs& step, Pair& pair) const;
  bool is_near(const Pair& pair) const;
  static double calc_gap(const Aabb& a, const Aabb& b);
  bool may_touch(const StepPairs& step, Pair& pair) const;

  WorldData& data_;
  const WorldSettings& settings_;
  const Bodies& bodies_;
  Pairs& pairs_;
  ThreadPool& pool_;
  // By collider: whether it leaves its enlarged box; of those that do, the boxes before and now.
  std::vector<std::uint8_t> leaves_box_;
  std::vector<Aabb> box_before_, box_after_;
  std::vector<std::vector<std::int32_t>> neighbours_;  // of the colliders that leave their box, in turn
  WantedList leaving_;
  std::vector<std::uint8_t> pair_states_;  // by pair: a PairState
};

}  // namespace rubble
