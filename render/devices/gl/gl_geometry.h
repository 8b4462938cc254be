// A scene's tables on the graphics card. Internal to render/devices/gl.
#pragma once

#include <cstdint>
#include <vector>

#include "render/geometry/scene_tables.h"
#include "render/gl/gl_exchange.h"

namespace rubble {

struct GlGeometry {
  // light: at all nodes, at first.
  GlGeometry(const Gl& gl, const PreparedScene& scene, SceneTables tables, const LightTable& light);

  void place(const PreparedScene& scene);  // where the pieces are now
  // changed: null: all of it. Of the ranges, what differs from what is there goes to the card.
  void set_light(const LightTable& light, const std::vector<LightRange>* changed);
  // In `indices`; triangle: number in the mesh.
  std::uint32_t first_index(std::uint32_t mesh, std::uint32_t triangle) const {
    return 3 * (tables.names.first_triangle[mesh] + triangle);
  }

  const Gl& gl;
  SceneTables tables;  // without those that are on the card
  GlBuffer vertices, indices, triangles, placed;
  GlMirror light;
  std::uint64_t light_version = 1;  // another number whenever the light has changed
  GlTexture vertices_view, triangles_view, placed_view, light_view;
  // See shaders/paint.glsl; nothing where nothing is painted.
  GlBuffer paint;
  GlTexture paint_view, paint_images;
};

}  // namespace rubble
