// Which cells of some space a camera has seen: those that lie before the surface that its rays meet.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/geometry/voxel_grid.h"

namespace rubble {

class SeenCells {
 public:
  // wanted: the cells that count, by their indices, each once.
  SeenCells(const VoxelGrid& grid, const std::vector<std::uint32_t>& wanted);

  // Every cell that a ray passes on its way.
  // direction: unit length; range: how far it goes; unit: m. Non-finite ranges are not allowed.
  void mark(const Vec3& from, const Vec3& direction, double range);
  void forget();

  std::size_t count() const { return count_; }   // of the wanted ones that were seen
  std::size_t wanted() const { return wanted_; }
  double share() const { return wanted_ ? double(count_) / double(wanted_) : 0; }
  bool is_seen(std::uint32_t cell) const { return state_[cell] == State::seen; }  // false: also where it does not count

 private:
  enum class State : std::uint8_t { ignored, hidden, seen };

  VoxelGrid grid_;
  std::vector<State> state_;
  std::size_t count_ = 0, wanted_ = 0;
};

}  // namespace rubble
