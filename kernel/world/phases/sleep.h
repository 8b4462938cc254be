// Selects the pieces of the next step: falling asleep, waking by neighbours, and the verification of rest. Not for use
// outside kernel/.
#pragma once

#include <utility>
#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/world/phases/step.h"
#include "kernel/world/phases/trees.h"
#include "kernel/world/state/bodies.h"
#include "kernel/world/state/waking.h"

namespace rubble {

class Sleep {
 public:
  Sleep(WorldData& data, const WorldSettings& settings, const Bodies& bodies, FreeBodies& blocks,
        WorldTrees& trees, Waking& waking, ThreadPool& pool)
      : data_(data),
        settings_(settings),
        bodies_(bodies),
        blocks_(blocks),
        trees_(trees),
        waking_(waking),
        pool_(pool) {}

  // A sleeper that is about to be hit hard enough takes part in this very step, so that momentum is
  // kept. Its other contacts are as it left them: neither side has moved.
  void wake_hit(StepPairs& step);
  // Last phase of a step.
  void run(const StepPairs& step);
  void put_all_to_sleep(const StepPairs& step);
  // Whether a piece has stayed where it is for long enough to count as at rest.
  bool within_rest_tolerance(const Body& body) const;

 private:
  std::int32_t find_hit(const StepPairs& step, std::int32_t pair) const;
  void wake_changed(const StepPairs& step);
  void limit_warm_start(const Body& sleeper, Contact& contact) const;
  float wake_impulse(const Body& body) const;  // a contact's must change by this; unit: N s
  void find_overlapping(const StepPairs& step);
  void count_still_steps(const StepPairs& step);
  void stay_awake_near_robots(const StepPairs& step);
  bool is_hastening(const Body& body) const;
  bool is_driven(std::int32_t body) const;
  bool touches_robot(const Contact& contact) const;
  void put_to_sleep(const StepPairs& step);  // those that slept_ marks
  void note_loads(const StepPairs& step);
  void fall_asleep(int body);
  // In verification.cpp:
  void update_verification(const StepPairs& step);
  int count_widenings() const;
  int mark_restless();
  void spread_disturbance(const StepPairs& step);
  void doze(const StepPairs& step);
  void wake_dozing();
  bool is_damped() const;
  void begin_undamped_try();

  WorldData& data_;
  const WorldSettings& settings_;
  const Bodies& bodies_;
  FreeBodies& blocks_;
  WorldTrees& trees_;
  Waking& waking_;
  ThreadPool& pool_;
  WantedList wanted_;
  std::vector<std::uint8_t> listed_;  // by pair, for wake_hit()
  std::vector<std::uint8_t> overlapping_, slept_, disturbed_;  // by body
  std::vector<Vec3f> lost_support_;                            // by body: of sleepers, to awake neighbours
  std::vector<std::pair<Contact*, std::int32_t>> throwing_;     // contacts that press far too hard on a sleeper, and who it is
  std::vector<std::int32_t> unsettled_;                        // sleepers whose lost_support_ is not zero
};

}  // namespace rubble
