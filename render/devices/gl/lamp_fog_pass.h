// The lamp's light in fog, by the card: what FogLight::set_lamp() finds on the processor, in the shaders fog_*. Internal to
// render/devices/gl.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "render/gl/gl_exchange.h"
#include "render/device/device_lamp.h"

namespace rubble {

class LampFogPass {
 public:
  // Of these links alone; `air` is not kept. reach: of the lamp; unit: m
  LampFogPass(const Gl& gl, const LampAir& air, float reach);

  struct Lamp {
    GLuint aim, seen, map;   // as in shaders/lamp_words.glsl and lamp_map.glsl
    GLuint radiance, lit;    // of bake points, as in shaders/lamp_send.comp.glsl
    const GlBuffer& radiance_buffer;
    const GlBuffer& frame;   // with the mean fog
  };
  void find(const LampAir& air, const Lamp& lamp);

  // Sixteen colours a point of the grid: by the air, then of all points by surfaces.
  const GlTexture& terms() const { return terms_view_; }
  const GlTexture& stand_in() const { return stand_in_view_; }
  const GlBuffer& stand_in_buffer() const { return stand_in_; }

 private:
  struct Programs {
    GlProgram direct, begin, lit[4], gather, check, emit, follow, project, sides;
  };
  void run(const GlProgram& program, GLuint groups_x, GLuint groups_y = 1);

  const Gl& gl_;
  Programs programs_;
  std::uint32_t points_;
  GlBuffer grid_, state_, air_points_, matter_, total_, emitted_, ends_in_, air_in_, terms_, stand_in_;
  GlBuffer link_ends_, first_place_, seen_corners_, nearest_, hidden_;
  GlTexture link_ends_view_, first_place_view_, seen_corners_view_, nearest_view_, hidden_view_, terms_view_, stand_in_view_,
      radiance_view_;
  std::uint64_t matter_version_ = 0;
};

}  // namespace rubble
