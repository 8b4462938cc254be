#include "render/media/air_glow.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/quick_math.h"


namespace rubble {

Vec3f even_glow(const AirLight& baked, const LightSet& lights, const Scatterer& air, const Vec3f& p) {
  const Vec3f near = baked.at(p);
  const bool local = std::any_of(lights.lights.begin(), lights.lights.end(), [](const LightModel& light) {
    return light.type != LightType::directional;
  });
  if (air.drops <= 0 || !local || baked.radiance.size() == 1) return near;
  const Vec3f open = lights.sky.mean * (0.5f * (1 + kGroundReflectance));
  const Vec3f size = (baked.nearest({1e9f, 1e9f, 1e9f}) - baked.origin) * 0.5f;
  const float away = 1 + norm(p - baked.nearest(p)) / norm(size);
  return open + (near - open) * (1 / (away * away));
}

// Light of the lamp that is scattered at p towards the lens, against `direction`.
Vec3f lamp_glow(const AirLamp& lamp, const Scatterer& air, const Vec3f& p, const Vec3f& direction,
                double depth_to_p) {
  const Vec3f from = p - lamp.position;
  const float d2 = std::max(dot(from, from), lamp.size2), d = std::sqrt(d2);
  const float x = (1 - dot(from, lamp.axis) / d) * lamp.cone;
  const float strength = quick::exp2(-x * x) * float(quick::exp(-depth_to_p)) / d2;
  return lamp.colour * (strength * air.phase(double(-dot(from, direction) / d)));
}

}  // namespace rubble
