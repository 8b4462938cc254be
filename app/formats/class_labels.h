// The classes of the stream `label`: one table for pictures, depth, exports and legends.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/model/fines.h"
#include "kernel/model/pile.h"
#include "kernel/model/surroundings.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

class ClassLabels {
 public:
  // Sky, ground, each type of the pile; then, where the mission has them, robots, kinds of fines and of surroundings.
  ClassLabels(const Scenario& scenario, const std::vector<PieceType>& types);

  const std::vector<std::string>& names() const { return names_; }  // by number
  std::uint16_t of_type(int type) const;
  std::uint16_t of_robots() const { return robots_; }
  std::uint16_t of(FineKind kind) const { return std::uint16_t(fines_ + int(kind)); }
  std::uint16_t of(SurroundingKind kind) const { return std::uint16_t(surroundings_ + int(kind)); }

 private:
  std::vector<std::string> names_;
  std::uint16_t robots_, fines_, surroundings_;  // the first of each
};

}  // namespace rubble
