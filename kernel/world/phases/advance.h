// Fourth phase of a step: free bodies move. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/world/phases/contact_solution.h"
#include "kernel/world/state/bodies.h"

namespace rubble {

class Advance {
 public:
  Advance(WorldData& data, const WorldSettings& settings, Bodies& bodies, FreeBodies& blocks,
          ThreadPool& pool)
      : data_(data), settings_(settings), bodies_(bodies), blocks_(blocks), pool_(pool) {}

  // What touches nothing moves by its exact parabola; the others as `motions` say, within the limits of spin.
  void run(const StepPairs& step, const StepMotions& motions, const ContactSolution& solution,
           const SpeedLimiter& limits);

 private:
  // The speeds after the step, and the extra rates that make up its displacement.
  BodyRates find_rates(std::size_t body, const StepMotions& motions, const ContactSolution& solution,
                       const SpeedLimiter& limits) const;
  double calc_travel(const Body& body, const BodyRates& rates) const;
  void list_blocks(const StepPairs& step);

  WorldData& data_;
  const WorldSettings& settings_;
  Bodies& bodies_;
  FreeBodies& blocks_;
  ThreadPool& pool_;
  std::vector<std::uint8_t> block_awake_;
  std::vector<std::int32_t> body_of_;  // by number in FreeBodies
  std::vector<std::uint8_t> moves_;    // by number in FreeBodies
};

}  // namespace rubble
