// Which room is taken by fines already, so that they do not lie in each other.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

class RoomForFines {
 public:
  // Takes the room of a ball where no other is nearer than kFineCloseness of their radii together; false and
  // nothing taken otherwise.
  bool take(const Vec3& centre, double radius);

 private:
  struct Ball {
    Vec3 centre;
    double radius;
  };
  std::unordered_map<std::uint64_t, std::vector<Ball>> cells_;  // asked, never walked
};

inline constexpr double kFineCloseness = 0.75;

}  // namespace rubble
