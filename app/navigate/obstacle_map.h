// The robot's own map: which cells of space its scanner saw something in.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/geometry/voxel_grid.h"

namespace rubble {

class ObstacleMap {
 public:
  // bounds: what is outside of them is not mapped; unit: m. hits: echoes that make a cell occupied.
  ObstacleMap(const Aabb& bounds, double voxel, int hits);

  // An echo. As long as no scan is added, nothing takes it out again.
  void add(const Vec3& point);
  // A scan. What it saw is in the map with as many scans as are `hits`, and gone again when scans see through it: echoes of
  // two things at once lie between them, poses are a little wrong, and debris moves. sensor, echoes: in the map's frame;
  // unit: m.
  void add_scan(const Vec3& sensor, const std::vector<Vec3>& echoes);
  bool is_occupied(const Vec3& point) const;
  // One layer of cells, as wide as the map; of it those with an occupied cell between two heights, ascending; unit: m.
  VoxelGrid flat_grid() const;
  std::vector<Cell> find_columns(double lowest, double highest) const;
  // Middles of the occupied cells in an upright box around a place, x fastest, z slowest; unit: m.
  std::vector<Vec3> find_around(const Vec3& place, double reach, double lowest, double highest) const;

 private:
  enum class Now : std::uint8_t { untouched, passed, hit };  // by the scan that is being added

  void touch(std::size_t cell, Now how);

  VoxelGrid grid_;
  std::uint8_t occupied_;           // evidence that makes a cell occupied
  std::vector<std::uint8_t> seen_;  // evidence
  std::vector<Now> now_;            // empty: no scan was added yet
  std::vector<std::uint32_t> touched_;
};

}  // namespace rubble
