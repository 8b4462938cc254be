// Finds pieces that were thrown by more than gravity.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/world/world.h"

namespace rubble {

// Faster sideways or upwards than this is too fast: a fall of 7 m onto a slope gives 6. unit: m/s
inline constexpr double kEjectionSpeed = 8.0;

// The step in which a piece became too fast.
struct Ejection {
  int piece = 0;
  std::int64_t step = 0;
  Vec3 before, after;  // its velocity one step earlier, and then; unit: m/s
  Vec3 place;          // of its origin; unit: m
};

class EjectionWatch {
 public:
  explicit EjectionWatch(const World& world) : world_(world) {}

  // Call after each step. Looks at the pieces that are awake.
  void look();
  // One per piece, in the order in which it happened.
  const std::vector<Ejection>& ejected() const { return ejected_; }

 private:
  const World& world_;
  std::vector<Vec3> last_;          // velocities one step earlier, by piece
  std::vector<std::uint8_t> seen_;  // ejected already
  std::vector<Ejection> ejected_;
};

}  // namespace rubble
