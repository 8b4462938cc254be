// Light that is scattered towards an eye at one point of the air.
#pragma once

#include "render/lighting/bake.h"
#include "render/lighting/radiance_grid.h"
#include "render/media/medium.h"

namespace rubble {

// What shines into the air besides what is baked.
struct AirLamp {
  Vec3f position, axis, colour;  // world; the way it looks; kcd
  float cone = 0;                // 1 / (1 - cosine of the half-power angle)
  float size2 = 4e-4f;           // square of its size, nearer than which it gets no brighter; m2
};

// Light of the place where it comes to the air.
struct LitAir {
  const AirLight& baked;      // of clear air
  const LightSet& lights;     // that were baked
  const RadianceGrid* field;  // in this air, all but beams; null: it is not known, what is baked stands for it
  Aabb box;                   // in which the air weakens the beams
  bool lamp_on_device = false;  // the device knows what the air scatters of the lamp's light, instead of the field
};

// What scatters light at a point: shares of fog, of dust and of drops.
struct Scatterer {
  double fog = 1, dust = 0, drops = 0, fog_g = 0, dust_g = 0;
  // Light of this illuminance that goes on by an angle of this cosine, per unit of scattering.
  float phase(double cosine) const {
    const double of_drops = drops > 0 ? drops * phase_function(Precipitation::kAsymmetry, cosine) : 0;
    return float((fog > 0 ? fog * phase_function(fog_g, cosine) : 0) +
                 (dust > 0 ? dust * phase_function(dust_g, cosine) : 0) + of_drops);
  }
};

// Of what is far away.
inline constexpr float kGroundReflectance = 0.2f;

// Light from all around: the mean radiance of sky and surfaces. Beyond the baked air, what local lights add to it falls
// with the square of the distance in units of that air's size, down to that of the sky over level ground.
Vec3f even_glow(const AirLight& baked, const LightSet& lights, const Scatterer& air, const Vec3f& p);

// Light of the lamp that is scattered at p towards the lens, against `direction`.
Vec3f lamp_glow(const AirLamp& lamp, const Scatterer& air, const Vec3f& p, const Vec3f& direction,
                double depth_to_p);

}  // namespace rubble
