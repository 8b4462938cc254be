// What the light in the air before a camera is found from, see air_trace.h.
#pragma once

#include <cstdint>

#include "render/shading/air_block.h"

namespace rubble {

struct AirTraceData : AirBlock {
  struct Puff {
    float place[4];      // its middle, and its standard deviation; unit: m
    float extinction;    // in its middle; unit: 1/m
    float unused[3] = {};
  };

  const float* rays = nullptr;  // six numbers of all rays in turn: eye X, Y, Z, direction X, Y, Z, in the world
  const std::int32_t* wanted = nullptr;  // slices of each ray that are read
  const float* noise = nullptr;          // a repeated block
  const Puff* puffs = nullptr;
  // Light that is baked in clear air: four numbers a point.
  const float* radiance = nullptr;  // as AirLight::radiance
  const float* direct = nullptr;    // light after light
  // Light from all around, by orders of spherical harmonics: of every so-many-th ray six times four numbers (red, green,
  // blue, and those of the lamp's light).
  const float* around = nullptr;
  const float* near_glow = nullptr;  // as NearGlow: rows of sixteen numbers by the angle

  float* table = nullptr;  // as AirVolume::table()
};

}  // namespace rubble
