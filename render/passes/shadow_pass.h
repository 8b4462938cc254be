// The shadow maps of all lights, drawn once: neither lights nor pieces move. One view for the sun and
// for narrow spots, six (a cube) for the others.
#pragma once

#include <array>
#include <vector>

#include "render/geometry/geometry.h"
#include "render/lighting/lighting.h"

namespace rubble {

struct ShadowMap {
  GlTexture depth;  // array of GL_DEPTH_COMPONENT32F, compared by GL_LEQUAL
  std::vector<std::array<std::array<float, 4>, 4>> clip_from_world;  // rows, one a layer
  struct Light {
    int first_view = 0, views = 1;
    float texel = 0;  // width across the beam (directional; m) or per metre of distance
  };
  std::vector<Light> lights;
};

// size: side of one view at most, with less for many views; unit: texel.
ShadowMap draw_shadow_map(const Gl& gl, const PreparedScene& scene, const GpuGeometry& geometry,
                          const LightSet& lights, int size);

}  // namespace rubble
