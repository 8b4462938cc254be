// ColourPass by the graphics device, see shaders/resolve.frag.glsl.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/colour/colour_pass.h"
#include "render/devices/gl/air_pass.h"
#include "render/devices/gl/contact_pass.h"
#include "render/devices/gl/gl_raster.h"
#include "render/devices/gl/gl_shadow_pass.h"
#include "render/devices/gl/lamp_pass.h"
#include "render/devices/gl/sun_shadow_pass.h"
#include "render/geometry/ground_map.h"
#include "render/gl/gl_exchange.h"
#include "render/gl/shader.h"
#include "render/materials/textures.h"

namespace rubble {

class GlColourPass : public ColourPass {
 public:
  // What they refer to must outlive it. lamp: null as long as no lamp was lit.
  GlColourPass(const Gl& gl, const GlGeometry& geometry, const GlRaster& raster, const GlShadowPass& shadows,
               const std::unique_ptr<LampPass>& lamp, const FrameLight& light, const GroundMap& ground, const std::vector<PatternImage>& patterns);

  float meter(const ViewProjection& view, const Pose& world_from_camera,
              const SurfaceImages& surfaces, const FrameLight& light) override;
  void draw(const ViewProjection& view, const Pose& world_from_camera,
            const SurfaceImages& surfaces, const FrameLight& light, std::optional<float> exposure,
            bool metered) override;
  std::unique_ptr<DrawnColours> finish(const SurfaceImages& surfaces, bool smooth) override;
  std::unique_ptr<DrawnRadiance> draw_linear(const ViewProjection& view, const Pose& world_from_camera,
                                             const SurfaceImages& surfaces, const FrameLight& light) override;
  std::unique_ptr<LightWatch> make_light_watch(const WatchedPixels& pixels) override;
  std::vector<LightChange> draw_changes(const ViewProjection& view, const Pose& world_from_camera,
                                        const SurfaceImages& surfaces, const FrameLight& light, LightWatch& watch) override;

 private:
  // What is drawn behind glass, as a view by itself: see GlassLayer.
  struct Behind {
    GlTexture colour;
    GlFramebuffer target;
  };
  void resize(int width, int height);
  void draw_radiance(const ViewProjection& view, const Pose& world_from_camera, const SurfaceImages& surfaces,
                     const FrameLight& light);
  void hand_over(const ViewProjection& view, const SurfaceImages& surfaces);
  void draw_behind(const ViewProjection& view, const Pose& world_from_camera, const SurfaceImages& surfaces,
                   const FrameLight& light);
  // exposure: none: of what draw_meter() has drawn. anew: not as the time before, so what is found from the surfaces and the light is not there yet.
  void draw_with(int variant, const GlFramebuffer& target, const ViewProjection& view,
                 const Pose& world_from_camera, const SurfaceImages& surfaces,
                 const FrameLight& light, std::optional<float> exposure, bool anew = true,
                 const GlassLayer* layer = nullptr);  // layer: that alone is drawn

  const Gl& gl_;
  const GlGeometry& geometry_;
  const GlRaster& raster_;
  const GlShadowPass& shadows_;
  const std::unique_ptr<LampPass>& lamp_;
  enum Variant { kLinear = 1, kRays = 2, kLamp = 4, kMeter = 8, kSoftSun = 16, kBehind = 32 };
  const GlProgram& program(int variant);  // made when it is first needed
  void draw_meter(const ViewProjection& view, const Pose& world_from_camera, const SurfaceImages& surfaces,
                  const FrameLight& light);
  void draw_sun(const ViewProjection& view, const SurfaceImages& surfaces);

  ShaderDefines defines_;
  GlProgram programs_[64];  // by Variant
  GlBuffer frame_block_;
  GlVertexArray empty_array_;
  ContactPass contact_;
  AirPass air_;
  std::unique_ptr<SunShadowPass> sun_;  // null: the main light is no sun
  GlTexture looks_, sky_map_, ground_map_;
  GlTexture ids_, depth_, lens_rays_, row_poses_;  // of what was drawn last; the first two unless they are in the raster
  int given_width_ = 0, given_height_ = 0;         // of these
  std::uint64_t lens_ = 0;                         // of lens_rays_
  const GroundMap& ground_;
  const GlTexture* nodes_ = nullptr;  // light for what was drawn last
  std::vector<Behind> behind_;  // the outermost first
  const GlTexture* shown_behind_ = nullptr;  // by what is drawn next; null: nothing
  GlTexture colour_, metered_, radiance_;
  GlFramebuffer target_, meter_target_, radiance_target_;
  int radiance_width_ = 0, radiance_height_ = 0;
  GlProgram exposure_;  // of what was metered, into the block of the frame
  GlProgram finish_programs_[2];  // by `smooth`
  GlBuffer rgb_;                  // three bytes a pixel
  GlReadback readback_;
  int width_ = 0, height_ = 0;
  int texture_size_ = 1;
};

}  // namespace rubble
