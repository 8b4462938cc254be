#include "kernel/fines/room_for_fines.h"

#include <cmath>

namespace rubble {
namespace {

constexpr double kRoomCell = 0.05;  // unit: m

// Calls visit(key) for each cell that a ball's box is in, until it gives false.
template <typename Visit>
bool each_cell(const Vec3& centre, double radius, const Visit& visit) {
  const auto cell = [](double x) { return std::int64_t(std::floor(x / kRoomCell)); };
  const auto bits = [](std::int64_t i) { return std::uint64_t(i) & 0x1fffffu; };
  for (std::int64_t z = cell(centre.z - radius); z <= cell(centre.z + radius); ++z)
    for (std::int64_t y = cell(centre.y - radius); y <= cell(centre.y + radius); ++y)
      for (std::int64_t x = cell(centre.x - radius); x <= cell(centre.x + radius); ++x)
        if (!visit(bits(x) | bits(y) << 21 | bits(z) << 42)) return false;
  return true;
}

}  // namespace

bool RoomForFines::take(const Vec3& centre, double radius) {
  const auto is_free = [&](std::uint64_t key) {
    const auto found = cells_.find(key);
    if (found == cells_.end()) return true;
    for (const Ball& ball : found->second)
      if (distance(ball.centre, centre) < kFineCloseness * (ball.radius + radius)) return false;
    return true;
  };
  if (!each_cell(centre, radius, is_free)) return false;
  return each_cell(centre, radius, [&](std::uint64_t key) {
    cells_[key].push_back({centre, radius});
    return true;
  });
}

}  // namespace rubble
