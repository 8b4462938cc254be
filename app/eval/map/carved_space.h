// What a map knows of the space in a grid: free along the rays from the cameras to its surface.
#pragma once

#include <cstdint>
#include <vector>

#include "app/eval/map/recorded_views.h"
#include "kernel/base/parallel.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/void_space.h"

namespace rubble {

// A point may have been measured by a frame when the true surface is at most this much nearer than
// the point; unit: m
inline constexpr double kCarveSlack = 0.05;

class CarvedSpace {
 public:
  // Cells that the points of a map are in are its surface. From every frame a ray goes to each such
  // cell (to the mean of its points) that is in the picture and range and that the true pile does
  // not hide; the cells before the first one of the map's surface are carved free. This is how
  // occupancy grids are made from depth images, with the map in place of the images, and so for any
  // map, however it was made. Without the true pile's say, rays would pass between the points of a
  // sparse map, through walls, to points that were measured from elsewhere.
  CarvedSpace(const VoxelGrid& grid, const std::vector<Vec3>& map, const PileQueries& truth,
              const RecordedViews& views, ThreadPool& pool);

  bool is_free(std::size_t cell) const { return state_[cell] == State::free; }
  // Free, or of the map's surface with a free cell beside it (of the 26).
  bool is_known(std::size_t cell) const;
  // Whether all within `radius` of a cell's centre is free, but for half a cell's diagonal, as a cell
  // that the surface only touches is not free as a whole.
  bool has_room(std::size_t cell, double radius) const;

 private:
  enum class State : std::uint8_t { unknown, surface, free };

  void carve(const Vec3& from, const Vec3& to);

  const VoxelGrid grid_;
  std::vector<State> state_;
};

// How much of the voids for a robot, and which of their entrances, a map knows.
struct FoundVoids {
  double volume = 0;                      // unit: m3
  std::vector<std::vector<char>> entrances;  // of each void, of each of its entrances: found
};
struct RobotVoids;
FoundVoids find_known_voids(const VoidSpace& space, const RobotVoids& robot,
                            const CarvedSpace& carved);
// Of all void cells; unit: m3.
double calc_known_volume(const VoidSpace& space, const CarvedSpace& carved);

}  // namespace rubble
