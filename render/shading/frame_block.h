// What is the same for all pixels of an image, as shaders/frame.glsl has it, which also says what
// each number is.
#pragma once

namespace rubble {

inline constexpr int kMostShadedLights = 4;  // kMostLights
inline constexpr int kMostShadowViews = 6 * kMostShadedLights;
inline constexpr int kMostShadedLooks = 45;  // kMaxSurfaceAppearances

struct FrameBlock {
  float world_from_optical[3][4];
  float lens[4], view[4];
  float light_position[kMostShadedLights][4], light_axis[kMostShadedLights][4],
      light_colour[kMostShadedLights][4];
  float lamp_position[4], lamp_axis[4], lamp_colour[4];
  float wetness[4];
  float sun_direction[4], sun_radiance[4], skyline[4];
  float ground[4], air_low[4], air_high[4], air_drops[4], balance[4];
  float shadow_rows[kMostShadowViews * 4][4];
  float looks[kMostShadedLooks * 4][4];
};

}  // namespace rubble
