// Baked light as the graphics device holds it.
#pragma once

#include <cstdint>

#include "render/geometry/geometry.h"

namespace rubble {

// The strength of a light by equal weights, so that it is linear in what BakedLight keeps.
inline float luminance(const Vec3f& c) { return (c.x + c.y + c.z) * (1.0f / 3); }

// Bits of the nearest half float, ties away from zero; beyond 60000 it is clamped.
std::uint16_t to_half(float x);
float from_half(std::uint16_t half);

// vector: dot(n, vector) is the illuminance for the normal n; colour: its tint, of any strength.
BakedLight pack_light(const Vec3f& vector, const Vec3f& colour);

// Back again: the colour has the strength that falls on the normal.
struct UnpackedLight {
  Vec3f vector, colour;
};
UnpackedLight unpack_light(const BakedLight& light, const Vec3f& normal);

}  // namespace rubble
