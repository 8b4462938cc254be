// What is the same for all pixels of an image, as shaders/frame.glsl has it, which also says what
// each number is.
#pragma once

namespace rubble {

inline constexpr int kMostShadedLights = 4;  // kMostLights
inline constexpr int kMostShadowViews = 6 * kMostShadedLights;
inline constexpr int kMostShadedLooks = 45;  // kMaxSurfaceAppearances

struct FrameBlock {
  float world_from_optical[3][4];  // rows
  float lens[4], view[4];          // 1/fx, 1/fy, cx, cy; near plane, exposure, width, height
  float light_position[kMostShadedLights][4], light_axis[kMostShadedLights][4],
      light_colour[kMostShadedLights][4];
  float lamp_position[4], lamp_axis[4], lamp_colour[4];  // in the world; unit: m, 1, kcd
  float wetness[4];  // of surfaces; and what shifts the noise of 8 bits
  float sun_direction[4], sun_radiance[4], skyline[4];  // the last two in kcd/m2
  float ground[4], air_low[4], air_high[4], air_drops[4],
      balance[4];                              // map, box and losses of the air, white balance
  float shadow_rows[kMostShadowViews * 4][4];  // of clip_from_world, four a view
  float looks[kMostShadedLooks * 4][4];        // four a look
};

}  // namespace rubble
