// A scene as tables of numbers, from which every device shades: see shaders/geometry.glsl. Internal to render/.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/geometry/geometry.h"

namespace rubble {

// A drawn pixel names its triangle by that triangle's last vertex in the tables, which is its own.
struct TriangleNames {
  std::vector<std::uint32_t> first_triangle;    // of each prepared mesh, among all triangles
  std::vector<std::uint32_t> name_of_triangle;  // of all triangles
  std::vector<std::uint32_t> triangle_of_name;  // its number in its prepared mesh

  std::uint32_t name(std::uint32_t mesh, std::uint32_t triangle) const {
    return name_of_triangle[first_triangle[mesh] + triangle];
  }
};

struct SceneTables {
  using Texel = std::array<std::uint32_t, 4>;

  std::vector<Texel> vertices, triangles, placed;  // see shaders/geometry.glsl
  std::vector<Texel> paint;                        // see shaders/paint.glsl; empty where paint_count is 0
  std::size_t paint_count = 0;
  int paint_side = 1;                              // of the images; unit: texel
  std::vector<std::uint32_t> indices;              // three vertices a triangle, the one that names it last
  std::vector<std::uint32_t> first_vertex;         // of each prepared mesh
  TriangleNames names;

  void place(const PreparedScene& scene);  // where the pieces are now
};
SceneTables make_scene_tables(const PreparedScene& scene);
// Octahedral, in two 16-bit signed parts (Cigolle et al. 2014): see shaders/packing.glsl.
std::uint32_t pack_normal(const Vec3f& normal);

}  // namespace rubble
