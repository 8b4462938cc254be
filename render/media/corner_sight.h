// Which points of a grid of the air a place sees. Light is taken from between those alone: behind a wall it may be a
// thousand times as bright.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/geometry/geometry.h"
#include "render/geometry/ray_scene.h"
#include "render/lighting/radiance_grid.h"

namespace rubble {

class CornerSight {
 public:
  // rays: of the scene; they and the grid must outlive it.
  CornerSight(const PreparedScene& scene, const RayScene& rays, const AirGrid& grid);

  // Of the eight corners about a place that lies outside all pieces, in the order of AirGrid::about(), one bit each.
  std::uint8_t seen_from(const Vec3f& place) const;
  // Of parts of all cells, each `part` long (unit: m) or somewhat longer.
  SeenCorners table(float part, ThreadPool& pool) const;

 private:
  void note_triangles(const PreparedScene& scene);
  void note_box(const Aabb& box);
  bool inside(const Vec3f& place) const;

  const RayScene& rays_;
  const AirGrid& grid_;
  std::vector<std::uint8_t> crowded_;  // of each cell, by its lowest corner: something may lie in it
};

}  // namespace rubble
