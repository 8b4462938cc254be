// Limits speeds after impacts, and damps; see kernel/solver/speed_limits.h. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/world/phases/step.h"

namespace rubble {

class SpeedLimiter {
 public:
  SpeedLimiter(const WorldData& data, const WorldSettings& settings, ThreadPool& pool)
      : data_(data), settings_(settings), pool_(pool) {}

  // A piece squeezed out from under a heavy one must not shoot away: sideways and upwards it may become hardly
  // faster in one step than the points which touch it were before. What is pushed ahead may: along the velocity of the
  // fastest of these points it may become as fast. Nor must what lies on the ground be shot
  // through it: it moves down no faster than its own points or what strikes it did.
  void clamp_ejections(const StepPairs& step, StepMotions& motions);
  // What rolls is pushed where it is, however fast it turns: fills StepMotions::rolls.
  void find_rolling(const StepPairs& step, StepMotions& motions);
  static bool does_roll(std::size_t body, const StepMotions& motions);
  // 0 while a verification of rest may yet succeed by itself, 1 when it has lasted too long.
  float calc_lateness() const;
  // The share of its spin that a piece keeps in a step of a verification that lasts. spin: its length.
  float keep_of_late_spin(const Body& body, const Vec3f& angular, float spin, float lateness) const;
  // Notes how fast pieces are struck in this step, for calc_most_spin().
  void find_strikes(const StepPairs& step, const StepMotions& motions);
  // How fast contacts may turn a piece in this step; unit: rad/s.
  float calc_most_spin(std::int32_t body) const;

 private:
  bool may_kick(const Body& body) const;
  float speed_before(const Body& body) const;
  float sinking_before(const Body& body) const;
  bool find_kicked(const StepPairs& step, const StepMotions& motions);
  void look_around_kicked(const StepPairs& step);
  Vec3f find_beyond(std::int32_t body, const StepMotions& motions) const;
  void slow_down(std::int32_t body, const Vec3f& excess, StepMotions& motions) const;
  void clamp(std::int32_t body, StepMotions& motions);
  void return_momentum(std::size_t piece, const Vec3f& speed, StepMotions& motions);

  const WorldData& data_;
  const WorldSettings& settings_;
  ThreadPool& pool_;
  WantedList wanted_;
  std::vector<std::uint8_t> kicked_;     // by body: 1: too fast; 2: touches such a one, which may give it momentum
  std::vector<std::uint8_t> on_ground_;  // by body
  std::vector<float> fastest_;           // by body: of the points that touch it; unit: m/s
  std::vector<Vec3f> strikers_;          // by body: velocity of that point; unit: m/s
  std::vector<float> strikes_;           // by body that spins fast: closing speed of a contact at most; empty: none does; unit: m/s
  std::vector<std::int32_t> neighbour_;  // by body: the only one that touches it
  std::vector<std::int32_t> given_back_;  // bodies that got momentum back in this step
};

}  // namespace rubble
