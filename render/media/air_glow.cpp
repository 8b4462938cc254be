#include "render/media/air_glow.h"

#include <algorithm>
#include <cmath>

#include "render/lighting/light_packing.h"
#include "render/media/air_volume.h"

namespace rubble {

namespace {

constexpr float kGroundReflectance = 0.2f;  // of what is far away

// Of a light's illuminance at the border of the baked air, what is left farther away: fog hides what is there, drops do not.
float fading(const LightModel& light, const Vec3f& border, const LightModel::Sample& there) {
  const float at_border = luminance(light.at(border).illuminance);
  return at_border > 0 ? std::min(1.0f, luminance(there.illuminance) / at_border) : 0.0f;
}

}  // namespace

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
  const float strength = std::exp2(-x * x) * float(std::exp(-depth_to_p)) / d2;
  return lamp.colour * (strength * air.phase(double(-dot(from, direction) / d)));
}

// Of the lights that are not the lamp. What fog takes from them on the way to p arrives there all the
// same, from all around: only the rest still has a direction.
Vec3f light_glow(const AirLight& baked, const LightSet& lights, const Air& fog, const Scatterer& air,
                 const Vec3f& p, const Vec3f& direction) {
  Vec3f sum;
  for (std::size_t i = 0; i < lights.lights.size(); ++i) {
    Vec3f arriving = baked.direct_at(i, p);
    if (arriving == Vec3f()) continue;
    const LightModel::Sample light = lights.lights[i].at(p);
    if (air.drops > 0) arriving = arriving * fading(lights.lights[i], baked.nearest(p), light);
    const double way = std::min(double(light.distance), AirVolume::kFarthest);
    const auto straight = float(std::exp(-fog.fog_depth(Vec3(p), Vec3(light.to_light), way)));
    const float phase = air.phase(double(dot(light.to_light, direction)));
    sum += arriving * (straight * phase + (1 - straight) * 0.0795775f);  // 1 / (4 pi)
  }
  return sum;
}

}  // namespace rubble
