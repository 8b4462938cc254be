// Light scattered in the air of a scene whose surfaces are baked.
#pragma once

#include <cstdint>
#include <functional>

#include "render/geometry/ray_scene.h"
#include "render/lighting/bake.h"

namespace rubble {

struct AirBakeInput {
  const PreparedScene& scene;           // whose surfaces are baked
  const LightSet& light;                // that was baked
  const RayScene& rays;                 // of that scene
  std::function<Vec3f(std::uint32_t triangle)> radiosity;  // of a triangle of `rays`, over pi; unit: kcd/m2
  int threads = 1;                      // the result does not depend on it
};

// On a grid of at most 48 points an axis, 0.4 m apart where that suffices.
AirLight bake_air(const AirBakeInput& input);

}  // namespace rubble
