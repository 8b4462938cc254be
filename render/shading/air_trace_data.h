// What the light in the air before a camera is found from, see air_trace.h.
#pragma once

#include <cstdint>

#include "render/shading/frame_block.h"

namespace rubble {

struct AirTraceData {
  static constexpr int kMostSlices = 64;

  struct Puff {
    float centre[3], deviation, extinction;  // as DustPuff
  };
  struct Light {
    int type = 0;                           // 0 directional, 1 spot, 2 point
    float position[3], axis[3], colour[3];  // as LightModel has them
    float cos_outer = -1, cone_width = 1;   // the latter 1 / (inner - outer cosine)
  };

  // Rays, and slices of the air along them.
  int columns = 0, rows = 0, slices = 0;  // the first two are multiples of four
  const float* rays =
      nullptr;  // six numbers of all rays in turn: eye X, Y, Z, direction X, Y, Z, in the world
  const std::int32_t* wanted = nullptr;  // slices of each ray that are read
  float distance[kMostSlices] = {};      // of the table's entries from the eye; unit: m
  float drops[kMostSlices] = {};         // optical depth of rain and snow from the entry before

  // The medium, see media/medium.h.
  float fog_density = 0, fog_rate = 0,
        albedo = 1;                          // the second is 1 / height; 0: fog does not thin
  float fog_g = 0, dust_g = 0, drops_g = 0;  // mean cosines
  float billows = 0, billow_scale = 1,
        drift[3] = {};  // strength; 1 / size; how far the wind has carried them; unit: 1, 1/m, m
  const float* noise = nullptr;  // a repeated block
  int noise_side = 1;            // a power of two
  const Puff* puffs = nullptr;   // of dust
  int puff_count = 0;            // of these
  float beam_fog = 1,
        beam_drops =
            0;  // share of fog's extinction that beams lose, and extinction by drops; unit: 1, 1/m
  float box_low[3] = {}, box_high[3] = {};  // air_box()

  // Light that is baked in clear air, on a grid: four numbers a point.
  float origin[3] = {}, cell[3] = {1, 1, 1};
  int size[3] = {1, 1, 1};          // points along X, Y and Z
  const float* radiance = nullptr;  // as AirLight::radiance
  const float* direct = nullptr;    // light after light; null: none arrives anywhere
  Light lights[kMostShadedLights];  // that were baked
  int light_count = 0;              // of these
  bool local = false;               // one of them is not directional
  float open[3] = {};               // radiance over level ground far away
  float half_size = 1;              // of the grid's diagonal; unit: m

  // Light from all around in fog, by orders of spherical harmonics: of every so-many-th ray six
  // times four numbers (red, green, blue, and those of the lamp's light); null: not known, what is
  // baked stands for it.
  const float* around = nullptr;
  int around_columns = 0, around_rows = 0,
      shared = 1;  // of that coarser table; rays along an axis that share an entry

  bool lamp = false;  // there is one, see AirLamp
  float lamp_position[3] = {}, lamp_axis[3] = {}, lamp_colour[3] = {}, lamp_cone = 0,
        lamp_size2 = 1;
  const float* near_glow =
      nullptr;              // as NearGlow: rows of sixteen numbers by the angle; null: none
  int near_glow_steps = 0;  // from 0 to 180 degrees
  float near_glow_cell = 1, near_glow_reach = 0;  // unit: m

  float* table = nullptr;  // as AirVolume::table()
};

}  // namespace rubble
