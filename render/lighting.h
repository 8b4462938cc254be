// The light of a scene in physical units: one main light and the sky that goes with it. The same
// formulas stand in shaders/lighting.glsl.
//
// Luminance is in kcd/m2 and illuminance in klx: a white matt surface under E klx shows E / pi.
#pragma once

#include "kernel/base/math.h"
#include "render/scene.h"

namespace rubble {

// Radiance by elevation, brighter around the sun.
struct Sky {
  Vec3f zenith, horizon;  // unit: kcd/m2
  Vec3f glow;             // added towards the sun
  Vec3f sun_direction{0, 0, 1};

  // direction: unit length, pointing up or level; below the horizon it is black.
  Vec3f radiance(const Vec3f& direction) const;
};

struct LightModel {
  LightType type = LightType::directional;
  Vec3f position;                        // of spot and point lights; unit: m
  Vec3f axis;                            // the way the light travels
  Vec3f colour;                          // klx for directional, kcd otherwise
  float cos_outer = -1, cos_inner = -1;  // edge of a spot's cone; -1: none
  Sky sky;

  struct Sample {
    Vec3f to_light;     // unit length
    Vec3f illuminance;  // on a facing surface, without shadow; unit: klx
    float distance;     // to the light; unit: m; very large for directional
  };
  Sample at(const Vec3f& point) const;
};

LightModel make_light_model(const LightSpec& spec);

}  // namespace rubble
