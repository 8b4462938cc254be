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
  // the field of `air` has it. depth: near / Z of what the table is read up to, of a pinhole; null: `air` knows it.
  // lens_rays, row_poses: of a view whose pixels have rays of their own, else null.
  struct Known {
    const LampFogPass* lamp = nullptr;
    const GlTexture *depth = nullptr, *lens_rays = nullptr, *row_poses = nullptr;
  };
  void trace(const AirVolume& air, const GlBuffer& frame, const Known& known);
  // As AirVolume::table(), of the last air that was traced.
  const GlTexture& table() const { return table_; }

 private:
  void give_field(const RadianceGrid& field, bool lamp_is_there);
  const GlProgram& program(bool around, bool rays);  // made when it is first needed
  void find_wanted(const GlTexture& depth);

  const Gl& gl_;
  GlProgram programs_[2][2], wanted_programs_[2];
  GlMirror block_, wanted_, noise_, puffs_, radiance_, direct_, near_glow_;
  GlMirror field_, terms_, lamp_terms_, seen_, stand_in_, lamp_stand_in_;
  GlBuffer around_, least_, found_wanted_;
  GlTexture terms_view_, lamp_terms_view_, table_;
  std::uint64_t traced_ = 0;       // AirVolume::version()
  const float* noise_of_ = nullptr;
};

}  // namespace rubble
