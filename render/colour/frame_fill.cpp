#include "render/colour/frame_fill.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "render/materials/surface_appearance.h"
#include "render/surface/scalar_surface.h"

namespace rubble {

static_assert(kMostShadedLights == kMostLights && kMostShadedLooks == kMaxSurfaceAppearances);

namespace {

void set(float (&out)[4], const Vec3f& v, float w = 0) {
  out[0] = v.x, out[1] = v.y, out[2] = v.z, out[3] = w;
}

void fill_view(FrameBlock& block, const ViewProjection& view, float exposure) {
  const Mat3 r = view.world_from_optical.rotation.matrix();
  for (int i = 0; i < 3; ++i)
    set(block.world_from_optical[i], Vec3f(r.rows[i]),
        float(view.world_from_optical.translation[i]));
  const Intrinsics& k = view.intrinsics;
  set(block.lens, {float(1 / k.fx), float(1 / k.fy), float(k.cx)}, float(k.cy));
  set(block.view, {kNearPlane, exposure, float(k.width)}, float(k.height));
}

// A shift of the noise that hides the steps of 8 bits: noise that stayed where it is while the camera moves would be
// a landmark. number: of the image. It must not follow from the pose, or pictures of equal places would differ.
// Range: 0 to 1023 pixels either way.
Vec3f grain_shift(std::uint64_t number) {
  std::uint64_t hash = (number + 1) * 0x9e3779b97f4a7c15u;
  hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9u;
  hash ^= hash >> 32;
  return {0, float(hash >> 40 & 1023u), float(hash >> 50 & 1023u)};
}

void fill_lights(FrameBlock& block, const FrameLight& frame) {
  const auto& lights = frame.lights->lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const LightModel& light = lights[i];
    set(block.light_position[i], light.position, frame.shadow->lights[i].texel);
    const bool beam = light.type == LightType::directional;
    set(block.light_axis[i], light.axis,
        beam ? frame.shadow->lights[i].far_texel : light.cos_outer);
    set(block.light_colour[i], light.colour,
        1 / std::max(light.cos_inner - light.cos_outer, 1e-6f));
  }
  for (std::size_t v = 0; v < frame.shadow->clip_from_world.size(); ++v)
    std::memcpy(block.shadow_rows[v * 4], frame.shadow->clip_from_world[v].data(),
                sizeof block.shadow_rows[0] * 4);
}

// What the size of the lamp adds to squares of distances.
float lamp_spread(const LampSpec& lamp) {
  const float r2 = float(lamp.size * lamp.size / 4);
  if (lamp.shape == LampShape::point) return 0;
  return lamp.shape == LampShape::ring ? r2 : 0.5f * r2;
}

void fill_air_and_lamp(FrameBlock& block, const FrameLight& frame, const Pose& world_from_rig) {
  const double half = 0.5 * frame.lamp.cone_deg * portable::kPi / 180;
  set(block.lamp_position, Vec3f(world_from_rig * frame.lamp.position), lamp_spread(frame.lamp));
  set(block.lamp_axis, Vec3f(world_from_rig.rotation.rotate({1, 0, 0})),
      float(1 / (1 - portable::cos(half))));
  set(block.lamp_colour, lamp_colour(frame.lamp));
  const Sky& sky = frame.lights->sky;
  set(block.sun_direction, sky.sun_direction);
  set(block.sun_radiance, sky.sun_radiance);
  // Trees and roofs reflect about a tenth of what the sky and the sun give them.
  const LightModel& main = frame.lights->lights.front();
  const bool sunny = main.type == LightType::directional;
  set(block.skyline, sky.mean * 0.10f + (sunny ? main.colour * 0.02f : Vec3f()));
  set(block.balance, white_balance(*frame.lights));
}

void fill_fog(FrameBlock& block, const MeanFog& fog) {
  set(block.air_low, Vec3f(fog.box.min), float(fog.extinction));
  set(block.air_high, Vec3f(fog.box.max), fog.height > 0 ? float(1 / fog.height) : 0);
  set(block.air_drops, {float(fog.drops), float(fog.turned), 0});
}

void fill_surface_appearances(FrameBlock& block, int texture_size) {
  const std::vector<SurfaceAppearance>& looks = all_surface_appearances();
  for (std::size_t i = 0; i < looks.size() && i < kMaxSurfaceAppearances; ++i) {
    const SurfaceAppearance& l = looks[i];
    set(block.looks[i * 4], Vec3f(l.dark), 1 / l.tile);
    set(block.looks[i * 4 + 1], Vec3f(l.light), l.glow > 0 ? -l.glow : l.bump);
    set(block.looks[i * 4 + 2], Vec3f(l.accent),
        std::floor(255 * l.reflectance + 0.5f) + 0.99f * l.roughness);
    set(block.looks[i * 4 + 3], {float(l.pattern), l.dust, l.variation},
        quick::log2(float(texture_size) / l.tile));
  }
}

}  // namespace

FrameBlock fill_frame_block(const ViewProjection& view, const FrameLight& light, const Pose& bearer,
                            const GroundMap& ground, int texture_size, float exposure) {
  FrameBlock block{};
  fill_view(block, view, exposure);
  fill_lights(block, light);
  fill_air_and_lamp(block, light, bearer);
  fill_fog(block, light.fog);
  fill_surface_appearances(block, texture_size);
  set(block.wetness, grain_shift(light.noise) + Vec3f(float(light.wetness), 0, 0));
  set(block.ground, {ground.x, ground.y, 1 / ground.reach});
  return block;
}

bool has_lamp(const FrameLight& frame) { return frame.lamp.on && frame.lamp.intensity_cd > 0; }

bool light_shows(const FrameLight& light, float white_radiance, float exposure) {
  // Exposed radiance that moves the darkest of 8-bit values by a quarter, see shaders/tone.glsl.
  constexpr float kUnseen = 4e-4f;
  // And the peak of the mirrored part.
  const float film = light.wetness > 0 ? mirrored_peak(scalar::kWaterReflectance, scalar::kFilmRoughness) : 0.0f;
  return white_radiance * exposure * (1 + light.most_gloss + film) > kUnseen;
}

bool lamp_shows(const FrameLight& light, double lamp_offset, float nearest_value, float exposure) {
  if (nearest_value <= 0) return false;
  const Vec3f colour = lamp_colour(light.lamp);
  const float intensity = std::max(colour.x, std::max(colour.y, colour.z));
  const float offset = float(lamp_offset);
  const float distance = std::max(kNearPlane / nearest_value - offset, 0.01f);
  return light_shows(light, intensity / (float(portable::kPi) * distance * distance), exposure);
}

}  // namespace rubble
