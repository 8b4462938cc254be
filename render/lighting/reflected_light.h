// How light that comes by way of surfaces and the sky is reckoned, for the bake and for what moves.
#pragma once

#include "render/lighting/light_packing.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

inline Vec3f multiply(const Vec3f& a, const Vec3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

inline Vec3f mean_albedo(const SurfaceAppearance& look) {
  return Vec3f(look.dark * 0.45f + look.light * 0.45f + look.accent * 0.1f);
}

}  // namespace rubble
