// What lights an image.
#pragma once

#include "render/lighting/lighting.h"
#include "render/media/air_volume.h"
#include "render/passes/shadow_views.h"

namespace rubble {

// The air without its billows and puffs, as it weakens beams: Air::turned_depth().
struct MeanFog {
  double extinction = 0;  // at the ground; unit: 1/m
  double height = 0;      // over which it thins by e; 0: it does not; unit: m
  double drops = 0;       // extinction of rain and snow; unit: 1/m
  double turned = 1;      // of the extinction about the lamp, what weakens its beam
  Aabb box;               // air_box()
};

struct FrameLight {
  const LightSet* lights = nullptr;      // of the place; never null
  const ShadowViews* shadow = nullptr;   // of these lights; never null
  LampSpec lamp;                         // on the carrier below
  bool clear_air = true;                 // at all times
  double wetness = 0;                    // of surfaces
  float most_gloss = 1;                  // the largest mirrored_peak() of the looks in use
  bool glows = false;                    // a look in use shines by itself
  bool surrounded = false;               // as PreparedScene::surrounded
  bool glass = false;                    // as PreparedScene::glass
  AirVolume* air = nullptr;              // prepared for this frame, unless the air is clear
  MeanFog fog{};                         // of this frame
  const Pose* world_from_rig = nullptr;  // of what bears the lamp; null: the camera does
  std::uint64_t noise = 0;               // as ViewRays::noise
  bool soft_sun = true;                  // its shadows have a penumbra
  // Light that arrives at the nodes; never null.
  const LightTable* nodes = nullptr;
};

// Colours of the lamp's light; kcd.
Vec3f lamp_colour(const LampSpec& lamp);

// The most that a look mirrors of a light in any direction, as a multiple of what white matt
// plaster throws back; see gloss_lobe() in shaders/surface_model.glsl.
float mirrored_peak(float reflectance, float roughness);  // as in MirrorLayer

// Cameras take most of the light's own colour away: gains for a level grey surface under the open
// sky, of luminance 1.
Vec3f white_balance(const LightSet& lights);

}  // namespace rubble
