// The table of AirVolume by the card: shaders/air_around.comp.glsl and air_trace.comp.glsl. Internal to render/devices/gl.
#pragma once

#include <cstdint>

#include "render/devices/gl/lamp_fog_pass.h"
#include "render/gl/gl_exchange.h"
#include "render/media/air_volume.h"

namespace rubble {

class AirPass {
 public:
  explicit AirPass(const Gl& gl);

  // frame: the buffer of the FrameBlock of the view. lamp: its light in the air, where the card has found it, else null:
  // the field of `air` has it. lens_rays, row_poses: of a view whose pixels have rays of their own, else null.
  void trace(const AirVolume& air, const GlBuffer& frame, const LampFogPass* lamp, const GlTexture* lens_rays,
             const GlTexture* row_poses);
  // As AirVolume::table(), of the last air that was traced.
  const GlTexture& table() const { return table_; }

 private:
  void give_field(const RadianceGrid& field, bool lamp_is_there);
  const GlProgram& program(bool around, bool rays);  // made when it is first needed

  const Gl& gl_;
  GlProgram programs_[2][2];
  GlMirror block_, wanted_, noise_, puffs_, radiance_, direct_, near_glow_;
  GlMirror field_, terms_, lamp_terms_, seen_, stand_in_, lamp_stand_in_;
  GlBuffer around_;
  GlTexture terms_view_, lamp_terms_view_, table_;
  std::uint64_t traced_ = 0;       // AirVolume::version()
  const float* noise_of_ = nullptr;
};

}  // namespace rubble
