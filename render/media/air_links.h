// What the points of the air see: in each of some directions a surface or the sky, however far away. Found once for a
// scene; light of any kind is then carried along these links. And what it meets in the air on its way.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "render/geometry/geometry.h"
#include "render/geometry/ray_scene.h"
#include "render/lighting/radiance_grid.h"
#include "render/media/medium.h"

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
  // Of each link, by point, then by direction: where its places begin in `seen`.
  std::vector<std::uint32_t> first_place;
  // Of each place which of the corners about it it sees (see CornerSight): the middles of the link's stretches in turn, and
  // where the light of what it meets is asked for.
  std::vector<std::uint8_t> seen;

  // Of the point that is number `place` of the 27 about point i; i itself at the border.
  std::size_t neighbour(std::size_t i, int place) const;

  // From here on the functions say where the places of a link lie: how far from its point. unit: m
  float cell() const { return std::min(grid.cell.x, std::min(grid.cell.y, grid.cell.z)); }
  float length(std::size_t direction, std::size_t point) const;  // of its part within the box
  float place_before_end(float length) const { return std::max(length - 0.5f * cell(), 0.5f * length); }
  // Cuts it into stretches that grow with the distance, as what a direction stands for does: work(middle, length).
  template <typename Work>
  void cut(float length, const Work& work) const {
    constexpr float kWiden = 0.5f;
    for (float s = 0; s < length;) {
      const float step = std::min(std::max(cell(), kWiden * s), length - s);
      work(s + 0.5f * step, step);
      s += step;
    }
  }
};

// Points 0.4 m apart over the box, farther where that would be more than some thousands. scene: without what moves;
// bake points are counted over its placed meshes in turn. rays: of what light does not pass through there.
AirLinks make_air_links(const PreparedScene& scene, const RayScene& rays, const Aabb& box, int threads);

// The mean air at the points of a grid, without billows and puffs, as it turns light: see forward_share().
struct AirMatter {
  std::vector<float> extinction;                      // unit: 1/m
  std::vector<std::array<float, kOrders>> scattered;  // of what it takes, what it gives back of each order
};
AirMatter turning_matter(const Air& air, const AirGrid& grid);

}  // namespace rubble
