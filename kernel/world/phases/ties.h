// Ties: bars that hold two pieces after the concrete around them has failed. Each is solved as a
// contact between its anchors that pulls instead of pushing: its normal points from the second
// anchor to the first, and its gap is what it hangs through. Not for use outside kernel/.
#pragma once

#include <utility>
#include <vector>

#include "kernel/world/phases/step.h"
#include "kernel/world/state/bodies.h"
#include "kernel/world/state/waking.h"

namespace rubble {

class Ties {
 public:
  Ties(WorldData& data, const WorldSettings& settings, const Bodies& bodies, Waking& waking)
      : data_(data), settings_(settings), bodies_(bodies), waking_(waking) {}

  void add(const TieState& tie);  // throws InputError for one out of range

  // Those that are taut, or may become so, go behind the contacts: what hangs is solved from above. Bars
  // that bend brake the velocities.
  void begin(StepPairs& step, std::vector<Motion>& velocities);
  void end(StepPairs& step);  // back to where they are kept: behind the pairs nothing stays
  // What yielded is longer by as much as its anchors are now too far apart, and tears when nothing is left. So
  // does what contacts hold apart: it must not press pieces into each other.
  void stretch(const StepPairs& step);
  void drop_lost();  // of pieces that left the world

 private:
  Vec3f find_anchor(std::int32_t piece, const Vec3& anchor) const;
  double pose(Tie& tie) const;
  void bend(std::vector<Motion>& velocities) const;
  std::vector<std::pair<std::int32_t, std::int32_t>> find_pressed_deep(const StepPairs& step) const;

  WorldData& data_;
  const WorldSettings& settings_;
  const Bodies& bodies_;
  Waking& waking_;
  std::vector<std::int32_t> order_;  // ties in the solution, in their order
};

}  // namespace rubble
