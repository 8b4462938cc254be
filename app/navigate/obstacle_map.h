// The robot's own map: which cells of space its LiDAR saw something in. Nothing is ever taken out of it, as nothing
// moves.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/voids/voxel_grid.h"

namespace rubble {

class ObstacleMap {
 public:
  // bounds: what is outside of them is not mapped; unit: m. hits: echoes that make a cell occupied.
  ObstacleMap(const Aabb& bounds, double voxel, int hits);

  void add(const Vec3& point);
  bool is_occupied(const Vec3& point) const;
  // One layer of cells, as wide as the map; of it those with an occupied cell between two heights, ascending; unit: m.
  VoxelGrid flat_grid() const;
  std::vector<Cell> find_columns(double lowest, double highest) const;
  // Middles of the occupied cells in an upright box around a place, x fastest, z slowest; unit: m.
  std::vector<Vec3> find_around(const Vec3& place, double reach, double lowest, double highest) const;

 private:
  VoxelGrid grid_;
  std::uint8_t hits_;
  std::vector<std::uint8_t> seen_;  // echoes, up to hits_
};

}  // namespace rubble
