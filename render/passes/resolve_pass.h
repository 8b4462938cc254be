// Colours every pixel once, from the triangle that the visibility pass found there.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/geometry/geometry.h"
#include "render/geometry/ground_map.h"
#include "render/gl/shader.h"
#include "render/lighting/exposure.h"
#include "render/lighting/lighting.h"
#include "render/materials/textures.h"
#include "render/media/air_volume.h"
#include "render/passes/contact_pass.h"
#include "render/passes/image_tiles.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/sun_shadow_pass.h"

namespace rubble {

// The air without its billows and puffs, as it weakens beams: Air::turned_depth().
struct MeanFog {
  double extinction = 0, height = 0;  // at the ground; over which it thins by e, 0: it does not; unit: 1/m; m
  double drops = 0;                   // extinction of rain and snow; unit: 1/m
  double turned = 1;                  // of the extinction about the lamp, what weakens its beam
  Aabb box;                           // air_box()
};

struct FrameLight {
  const LightSet* lights = nullptr;      // of the place; never null
  const ShadowMap* shadow = nullptr;     // of these lights; never null
  LampSpec lamp;                         // on the carrier below
  bool clear_air = true;                 // at all times
  double wetness = 0;                    // of surfaces
  float most_gloss = 1;                  // the largest mirrored_peak() of the looks in use
  bool glows = false;                    // a look in use shines by itself
  bool surrounded = false;               // as PreparedScene::surrounded
  const AirVolume* air_table = nullptr;  // of this frame, unless the air is clear
  MeanFog fog{};                         // of this frame
  const Pose* world_from_rig = nullptr;  // of what bears the lamp; null: the camera does
  bool soft_sun = true;                  // its shadows have a penumbra
};

// Colours of the lamp's light; kcd.
Vec3f lamp_colour(const LampSpec& lamp);

// The most that a look mirrors of a light in any direction, as a multiple of what white matt plaster throws
// back; see gloss_lobe() in shaders/surface.glsl.
float mirrored_peak(float reflectance, float roughness);  // as in MirrorLayer

// Cameras take most of the light's own colour away: gains for a level grey surface under the open
// sky, of luminance 1.
Vec3f white_balance(const LightSet& lights);

// Which triangle each pixel shows, and how far it is.
struct SurfaceImages {
  const GlTexture& ids;    // as VisibilityPass::ids()
  const GlTexture& depth;  // near / Z
  const std::vector<float>& depth_values;  // the same
  // Of an image whose pixels have rays of their own, as RayPass has them; null: a pinhole.
  const GlTexture* lens_rays = nullptr;
  const GlTexture* row_poses = nullptr;  // null with lens_rays
};

class ResolvePass {
 public:
  ResolvePass(const Gl& gl, const GpuGeometry& geometry, const FrameLight& light,
              const GroundMap& ground, const std::vector<PatternImage>& patterns);

  // How bright the view is, for its exposure.
  MeteredImage meter(const ViewProjection& view, const Pose& world_from_camera,
                     const SurfaceImages& surfaces, const FrameLight& light);
  // Display colours: 4 bytes a pixel, the last unused. exposure: what luminance in kcd/m2 is
  // multiplied by. metered: meter() was the last call, for the same view.
  void draw(const ViewProjection& view, const Pose& world_from_camera,
            const SurfaceImages& surfaces, const FrameLight& light, float exposure, bool metered);
  void read(std::vector<std::uint8_t>& rgba);

  // Radiance before exposure and tone mapping, 4 floats a pixel (R, G, B in kcd/m2).
  std::vector<float> draw_linear(const ViewProjection& view, const Pose& world_from_camera,
                                 const SurfaceImages& surfaces, const FrameLight& light);

 private:
  void resize(int width, int height);
  void draw_with(int variant, const GlFramebuffer& target, const ViewProjection& view,
                 const Pose& world_from_camera, const SurfaceImages& surfaces,
                 const FrameLight& light, float exposure, bool with_contact = true);

  const Gl& gl_;
  const GpuGeometry& geometry_;
  enum Variant { kLinear = 1, kRays = 2, kLamp = 4, kMeter = 8, kSoftSun = 16 };
  const GlProgram& program(int variant, TileContent content);  // made when it is first needed
  ImageTiles tiles_of(const ViewProjection& view, const SurfaceImages& surfaces) const;
  bool draw_sun(const ViewProjection& view, const SurfaceImages& surfaces, const FrameLight& light);
  // lamp_offset: from the eye to the lamp; unit: m.
  bool lamp_shows(const FrameLight& light, double lamp_offset, const ImageTiles& tiles,
                  float exposure) const;
  void draw_tiles(int variant, const ImageTiles& tiles, int every);  // n-th pixel

  ShaderDefines defines_;
  GlProgram programs_[32][4];  // by Variant and TileContent
  GlBuffer frame_block_;
  GlVertexArray empty_array_;
  ContactPass contact_;
  std::unique_ptr<SunShadowPass> sun_;  // null: the main light is no sun
  GlTexture looks_, sky_map_, air_table_, ground_map_;
  float ground_[4];  // as in shaders/frame.glsl
  GlTexture colour_;
  GlFramebuffer target_;
  int width_ = 0, height_ = 0;
  int texture_size_ = 1;
};

}  // namespace rubble
