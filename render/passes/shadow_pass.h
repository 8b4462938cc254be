// The main light's shadow map, drawn once: neither the light nor the pieces move. One view for the
// sun and for narrow spots, six (a cube) for the others.
#pragma once

#include <array>
#include <vector>

#include "render/geometry.h"
#include "render/lighting.h"

namespace rubble {

struct ShadowMap {
  GlTexture depth;  // array of GL_DEPTH_COMPONENT32F, compared by GL_LEQUAL
  std::vector<std::array<std::array<float, 4>, 4>> clip_from_world;  // rows, one a layer
  float texel = 0;  // width on the ground of the scene (directional; m) or per metre of distance
};

// size: side of one view at most; unit: texel.
ShadowMap draw_shadow_map(const Gl& gl, const PreparedScene& scene, const GpuGeometry& geometry,
                          const LightModel& light, int size);

}  // namespace rubble
