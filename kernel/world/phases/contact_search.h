// Second phase of a step: the points at which active pairs touch, and a common way out for pieces that
// are stuck in each other. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/world/phases/step.h"
#include "kernel/world/state/bodies.h"

namespace rubble {

// Whether a contact overlaps too deep for its pieces to fall asleep soon.
bool overlaps_deep(const Contact& contact);

class ContactSearch {
 public:
  ContactSearch(WorldData& data, const WorldSettings& settings, const Bodies& bodies, ThreadPool& pool)
      : data_(data), settings_(settings), bodies_(bodies), pool_(pool) {}

  // The contacts of the active pairs, and in `step` which of them overlap.
  void run(StepPairs& step);

 private:
  // Two parts that overlap too deep.
  struct DeepPair {
    std::int32_t body_a = 0, body_b = 0;
    std::int32_t collider_a = 0, collider_b = 0;
    std::int32_t index = 0;  // of the pair; decides nothing

    bool operator<(const DeepPair& p) const;
  };

  void update_contacts(StepPairs& step);
  void update_pair(const StepPairs& step, Pair& pair, Contact& contact);
  void update_surface_slots(StepPairs& step, const Pair& first);
  void note_overlap(StepPairs& step, std::int32_t pair);
  // In overlaps.cpp:
  static bool is_stuck(const Contact& contact);
  void lead_out(StepPairs& step);
  void lead_out_of(StepPairs& step, const std::vector<std::int32_t>& deep);

  WorldData& data_;
  const WorldSettings& settings_;
  const Bodies& bodies_;
  ThreadPool& pool_;
  std::vector<DeepPair> deep_pairs_;
};

}  // namespace rubble
