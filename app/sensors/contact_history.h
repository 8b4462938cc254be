// How hard the links of robots pressed against anything else, in every step.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernel/world/world.h"

namespace rubble {

class ContactHistory {
 public:
  // step: of the world; unit: s
  ContactHistory() = default;
  explicit ContactHistory(double step) : step_(step) {}

  // After each step.
  void note(const World& world, int robots);
  // The largest sum of the normal forces on these links of a robot in the steps after `from` up to `to`, counted from the
  // start; unit: N, s
  double largest_force(std::size_t robot, const std::vector<std::size_t>& links, double from, double to) const;

 private:
  double step_ = 1;
  std::vector<std::vector<std::vector<double>>> forces_;  // by step, robot, link; empty: none on any
};

}  // namespace rubble
