// Islands of contacts: what touches, also through others, and how high it stands. Not for use outside kernel/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/base/disjoint_sets.h"

namespace rubble {

struct Island {
  std::int32_t contacts = 0;
  std::int32_t height = 0;  // pieces from the ground up, each on the first that it touches
};

class Islands {
 public:
  // Bodies have numbers below `bodies`, which itself stands for all that does not move.
  void begin(std::size_t bodies);
  // The contacts, bottom up: what is met for the first time lies on the other.
  void add(std::int32_t a, std::int32_t b);
  // After the last add(): counts contacts and heights by island.
  void finish();

  // After finish(): of a body, and the lowest number of its bodies.
  const Island& of(std::int32_t body) { return islands_[std::size_t(lowest_of(body))]; }
  const Island& with_lowest(std::int32_t lowest) const { return islands_[std::size_t(lowest)]; }
  std::int32_t lowest_of(std::int32_t body) { return sets_.find(body); }

 private:
  DisjointSets sets_;
  std::vector<std::int32_t> height_;    // by body; 0: not met yet, or does not move
  std::vector<std::int32_t> contacts_;  // by body, each counted at one of its bodies
  std::vector<Island> islands_;         // by body; those at the lowest number of an island count
};

}  // namespace rubble
