// The light of a scene in physical units: its lights, and the sky that goes with the main one. The
// same formulas stand in shaders/lighting.glsl.
//
// Luminance is in kcd/m2 and illuminance in klx: a white matt surface under E klx shows E / pi.
#pragma once

#include <vector>

#include "kernel/base/math.h"
#include "render/lighting/sky.h"
#include "render/scene/scene.h"

namespace rubble {

inline constexpr float kSunSolidAngle = 6.8e-5f;  // of its disc; unit: sr
inline constexpr float kSunRadius = 4.6525e-3f;  // of its disc, as that solid angle has it; unit: rad
inline constexpr float kLightReach = 1000.0f;  // of rays that look for light or for what hides it; unit: m

struct LightModel {
  LightType type = LightType::directional;  // never sun: that is a directional one by now
  Vec3f position;                           // of spot and point lights; unit: m
  Vec3f axis;                               // the way the light travels
  Vec3f colour;                             // klx for directional, kcd otherwise
  float cos_outer = -1, cos_inner = -1;     // edge of a spot's cone; -1: none

  struct Sample {
    Vec3f to_light;     // unit length
    Vec3f illuminance;  // on a facing surface, without shadow; unit: klx
    float distance;     // to the light; unit: m; very large for directional
  };
  Sample at(const Vec3f& point) const;
};
LightModel make_light_model(const LightSpec& spec);
// A carried light where its body is.
LightModel place_light(const CarriedLight& light, const Pose& world_from_body);

struct LightSet {
  std::vector<LightModel> lights;  // the main one first, carried ones last; 1 to kMostLights
  std::size_t carried = 0;         // of these
  std::vector<LightModel> far;     // Scene::far_lights
  Sky sky;                         // that goes with the main light

  std::size_t first_carried() const { return lights.size() - carried; }
  LightSet without_carried() const;
};
// Throws RunError for too many lights.
LightSet make_lights(const Scene& scene);

}  // namespace rubble
