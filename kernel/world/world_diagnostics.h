// What can be measured of all pieces of a world together.
#pragma once

#include <functional>

#include "kernel/solver/sweep_figures.h"
#include "kernel/world/world.h"

namespace rubble {

// The stages of a step, in their order.
enum class StepStage {
  pairs,     // pairs that may touch
  points,    // contact points
  impulses,  // contact impulses
  motion,
  rest,      // speed limits, sleep, lost pieces; before the motion and after it
  none,      // between two steps
};

class World::Diagnostics {
 public:
  DeepestOverlap deepest_overlap() const;  // of all contacts of the kernel
  bool all_have_touched() const;
  // Of all pieces, or of immovable pieces and those that have had a contact; 0 without any; unit: m
  double highest_point(bool touched_only = false) const;
  double kinetic_energy() const;    // unit: J
  double potential_energy() const;  // against z = 0, and of springs; unit: J
  Vec3 linear_momentum() const;     // unit: kg m/s
  Vec3 angular_momentum() const;    // about the origin; unit: kg m2/s

  // What so many threads would gain in the sweeps over the contacts of the last step, whatever the number of threads is.
  SweepFigures plan_sweeps(int threads) const;

  // Called at the beginning of each stage of a step, and with `none` at its end. Benches measure stages with it,
  // because a world reads no clock.
  void set_on_stage(std::function<void(StepStage)> on_stage);

 private:
  friend class World;
  explicit Diagnostics(Impl& world) : impl_(&world) {}

  Impl* impl_;
};

}  // namespace rubble
