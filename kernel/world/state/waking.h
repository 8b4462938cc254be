// Wakes sleeping pieces, at once or in the next step. Falling asleep: kernel/world/phases/sleep.h. Not for use outside
// kernel/.
#pragma once

#include "kernel/world/state/world_data.h"

namespace rubble {

// Speeds that wake are those of steps of 1/60 s: in a shorter step a force gives less speed.
inline constexpr double kStepsPerSecond = 60;  // unit: 1/s

class Waking {
 public:
  Waking(WorldData& data, const WorldSettings& settings) : data_(data), settings_(settings) {}

  void wake(int body);  // a link with all of its tree
  void wake_marked();   // those that WorldData::wake_next marks
  // A contact that is about to be forgotten: what it gave to sleepers is gone.
  void note_lost_contact(const Contact& contact);
  // Whether a sleeper must wake when the sum of what its contacts give it has changed by so much; unit: N s.
  bool is_unbalanced(const Body& body, const Vec3f& change) const;

 private:
  static void wake_one(Body& body);

  WorldData& data_;
  const WorldSettings& settings_;
};

}  // namespace rubble
