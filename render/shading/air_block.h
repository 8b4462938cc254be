// What the light in the air before a camera is found from, the same for all rays: as shaders/air_trace.comp.glsl has it, in
// the layout std430.
#pragma once

#include <cstdint>

#include "render/shading/frame_block.h"

namespace rubble {

struct AirBlock {
  static constexpr int kMostSlices = 64;

  struct Light {
    float position[4] = {}, axis[4] = {}, colour[4] = {};  // as LightModel has them
    std::int32_t type = 0;                                 // 0 directional, 1 spot, 2 point
    float cos_outer = -1, cone_width = 1;                  // the latter 1 / (inner - outer cosine)
    float unused = 0;
  };

  float drift[4] = {};                                 // how far the wind has carried the billows; unit: m
  float box_low[4] = {}, box_high[4] = {};             // air_box()
  float origin[4] = {}, cell[4] = {1, 1, 1};           // of the grid of light that is baked in clear air; unit: m
  float open[4] = {};                                  // radiance over level ground far away
  float lamp_position[4] = {}, lamp_axis[4] = {}, lamp_colour[4] = {};  // as AirLamp
  Light lights[kMostShadedLights];                     // that were baked
  float distance[kMostSlices] = {};                    // of the table's entries from the eye; unit: m
  float drops[kMostSlices] = {};                       // optical depth of rain and snow from the entry before
  std::int32_t size[4] = {1, 1, 1};                    // of the baked grid: points along X, Y and Z

  std::int32_t columns = 0, rows = 0, slices = 0;      // of the table; the first two are multiples of four
  // The medium, see media/medium.h.
  float fog_density = 0, fog_rate = 0, albedo = 1;     // the second is 1 / height; 0: fog does not thin
  float fog_g = 0, dust_g = 0, drops_g = 0;            // mean cosines
  float billows = 0, billow_scale = 1;                 // strength; 1 / size; unit: 1, 1/m
  std::int32_t noise_side = 1;                         // of the block of noise: a power of two
  std::int32_t puff_count = 0;                         // of dust
  float beam_fog = 1, beam_drops = 0;  // share of fog's extinction that beams lose, and extinction by drops; unit: 1, 1/m

  std::int32_t light_count = 0;                        // of `lights`
  std::int32_t local = 0;                              // 1: one of them is not directional
  std::int32_t has_direct = 0;                         // 0: none of their light arrives anywhere
  float half_size = 1;                                 // of the baked grid's diagonal; unit: m
  // Light from all around in fog: 0: it is not known, what is baked stands for it.
  std::int32_t has_around = 0, around_columns = 0, around_rows = 0;
  std::int32_t rays_an_entry = 1;                      // of the table, along an axis
  std::int32_t lamp = 0;                               // 1: there is one
  float lamp_cone = 0, lamp_size2 = 1;                 // as AirLamp
  std::int32_t has_near_glow = 0, near_glow_steps = 0; // the latter from 0 to 180 degrees
  float near_glow_cell = 1, near_glow_reach = 0;       // unit: m
  std::int32_t has_lens = 0;                           // 1: pixels have directions of their own; 0: a pinhole's
};

}  // namespace rubble
