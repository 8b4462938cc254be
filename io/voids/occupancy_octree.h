// A robot's own map: OctoMap's occupancy tree, whose cells have the log-odds of being solid (Hornung et al. 2013,
// "OctoMap: An efficient probabilistic 3D mapping framework based on octrees"). Its defaults: a hit is 0.7 likely to be
// right, a miss 0.6; a cell is solid from 0.5.
#pragma once

#include <memory>
#include <vector>

#include "kernel/geometry/voxel_grid.h"

namespace rubble {

class OccupancyOctree {
 public:
  explicit OccupancyOctree(double voxel);  // of its finest cells, of which cell (0, 0, 0) begins at the origin; unit: m
  ~OccupancyOctree();
  OccupancyOctree(const OccupancyOctree&) = delete;
  OccupancyOctree& operator=(const OccupancyOctree&) = delete;

  struct Change {
    Cell cell;
    bool occupied = false;
  };
  // A scan: rays from the origin to points. The cells that they pass are missed, those that they end in are hit, each once
  // and hits before misses; a ray longer than max_range hits nothing and is cut there. Gives the cells that became known,
  // and those whose answer changed, ascending. Points within 3,000 cells of the origin; unit: m.
  std::vector<Change> insert(const Vec3& origin, const std::vector<Vec3>& points, double max_range);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble
