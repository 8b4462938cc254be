#include "io/scenes/surface_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rubble {
namespace {

constexpr double kBelowGround = 0.05;  // unit: m

// Raises the corners under a triangle to its height.
void raise(const Vec3 (&t)[3], const SurfaceHeights& grid, std::vector<double>& heights) {
  const Vec3 low = min(min(t[0], t[1]), t[2]), high = max(max(t[0], t[1]), t[2]);
  const double area = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
  if (area == 0) return;
  const auto first = [&](double x, double origin) { return std::max(0, int(std::ceil((x - origin) / grid.spacing - 1e-9))); };
  const auto last = [&](double x, double origin, int count) {
    return std::min(count - 1, int(std::floor((x - origin) / grid.spacing + 1e-9)));
  };
  for (int r = first(low.y, grid.low.y); r <= last(high.y, grid.low.y, grid.rows); ++r) {
    for (int c = first(low.x, grid.low.x); c <= last(high.x, grid.low.x, grid.columns); ++c) {
      const double x = grid.low.x + c * grid.spacing, y = grid.low.y + r * grid.spacing;
      double shares[3];
      bool inside = true;
      for (int i = 0; i < 3; ++i) {
        const Vec3 &a = t[(i + 1) % 3], &b = t[(i + 2) % 3];
        shares[i] = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
        inside = inside && shares[i] >= -1e-9;
      }
      if (!inside) continue;
      double& height = heights[std::size_t(r) * std::size_t(grid.columns) + std::size_t(c)];
      height = std::max(height, shares[0] * t[0].z + shares[1] * t[1].z + shares[2] * t[2].z);
    }
  }
}

}  // namespace

SurfaceHeights calc_surface_heights(const std::vector<SimSurface>& surfaces, double spacing) {
  SurfaceHeights grid;
  constexpr double kFar = std::numeric_limits<double>::max();
  Vec3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  const auto place = [](const SimSurface& surface, std::uint32_t v) {
    return surface.world_from_mesh * (Vec3(surface.mesh->positions[v]) * surface.scale);
  };
  for (const SimSurface& surface : surfaces)
    for (const auto& t : surface.mesh->triangles)
      for (const std::uint32_t v : t) low = min(low, place(surface, v)), high = max(high, place(surface, v));
  if (high.x <= low.x || high.y <= low.y) return grid;
  grid.spacing = std::max(spacing, std::max(high.x - low.x, high.y - low.y) / (kMostHeightCorners - 1));
  grid.columns = std::max(2, int(std::floor((high.x - low.x) / grid.spacing + 1e-9)) + 1);
  grid.rows = std::max(2, int(std::floor((high.y - low.y) / grid.spacing + 1e-9)) + 1);
  grid.low = low;
  std::vector<double> heights(std::size_t(grid.columns) * std::size_t(grid.rows), -kBelowGround);
  for (const SimSurface& surface : surfaces)
    for (const auto& t : surface.mesh->triangles)
      raise({place(surface, t[0]), place(surface, t[1]), place(surface, t[2])}, grid, heights);
  const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
  grid.low.z = *lowest;
  grid.range = std::max(*highest - *lowest, 1e-3);
  for (const double height : heights) grid.shares.push_back(float((height - grid.low.z) / grid.range));
  return grid;
}

}  // namespace rubble
