// What the points of the air see: in each of some directions a surface or the sky, however far away. Found once for a
// scene; light of any kind is then carried along these links.
#pragma once

#include <cstdint>
#include <vector>

#include "render/geometry/geometry.h"
#include "render/geometry/ray_scene.h"
#include "render/lighting/radiance_grid.h"

namespace rubble {

struct AirLinks {
  static constexpr std::size_t kDirections = 64;
  static constexpr std::uint32_t kSky = 0xffffffffu, kDark = 0xfffffffeu;  // instead of a point; the inside of a piece
  struct End {
    float distance;       // unit: m
    std::uint32_t point;  // bake point that stands for what is met there
  };

  AirGrid grid;
  std::vector<Vec3f> directions;      // all over the sphere, each for as much of it
  std::vector<End> ends;              // by direction, then by point of the grid
  std::vector<std::uint32_t> nearest; // of each point: itself, or where it is inside a piece the nearest that is not
  std::vector<std::uint32_t> hidden;  // of each point: which of the 27 points about it it does not see, one bit each

  // Of the point that is number `place` of the 27 about point i; i itself at the border.
  std::size_t neighbour(std::size_t i, int place) const;
};

// Points 0.4 m apart over the box, farther where that would be more than some thousands. scene: without what moves;
// bake points are counted over its placed meshes in turn. rays: of what light does not pass through there.
AirLinks make_air_links(const PreparedScene& scene, const RayScene& rays, const Aabb& box, int threads);

}  // namespace rubble
