// Corrects where a robot thinks that it is by what it sees: the pose near a guess at which most points of a scan fall onto
// what was seen before (correlative scan matching; Olson 2009, "Real-time correlative scan matching").
//
// Seen from above: the rings of a scanner move with it, and in a map of three dimensions they would be found again best
// where the robot was.
#pragma once

#include <cstdint>
#include <vector>

#include "app/navigate_ros1/odometry_track.h"
#include "kernel/geometry/voxel_grid.h"

namespace rubble {

// What stands upright, from above: walls and blocks, no ground and no roof.
class PlanarMap {
 public:
  // Points of other heights are nothing to it; unit: m
  static constexpr double kLowest = 0.15, kHighest = 0.8;
  static bool holds(const Vec3& p) { return p.z >= kLowest && p.z <= kHighest; }

  // As ObstacleMap, but that one echo is enough.
  PlanarMap(const Aabb& bounds, double voxel);

  void add(const Vec3& place);
  // 1 where something was seen, 0.5 beside it, and 0 elsewhere.
  double value(double x, double y) const;

 private:
  void mark(const Cell& cell, std::uint8_t halves);

  VoxelGrid grid_;
  std::vector<std::uint8_t> halves_;  // twice the value
};

struct ScanMatch {
  PlanarPose pose;     // map_from_base; the guess where the map has too little of the scan
  bool found = false;  // it had enough
  double share = 0;    // mean value of the map at the points there
};

// points: in the robot's frame, that PlanarMap holds; unit: m. It looks up to 0.1 m and 0.12 rad around the guess.
ScanMatch match_scan(const PlanarMap& map, const std::vector<Vec3>& points, const PlanarPose& guess);

}  // namespace rubble
