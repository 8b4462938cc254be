#include "render/media/air_glow.h"

#include <algorithm>
#include <cmath>

#include "render/lighting/light_packing.h"
#include "render/media/air_box.h"

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

Vec3f light_glow(const LitAir& lit, const Air& fog, const Scatterer& air, const Vec3f& p, const Vec3f& direction) {
  Vec3f sum;
  if (lit.baked.direct.empty()) return sum;
  for (std::size_t i = 0; i < lit.lights.lights.size(); ++i) {
    const LightModel& model = lit.lights.lights[i];
    const LightModel::Sample light = model.at(p);
    float near = 0, far = light.distance;
    Vec3f arriving;
    if (model.type == LightType::directional) {
      // Outside the box the shadow is that of where the beam leaves it.
      const bool through = clip_to_box(lit.box, p, light.to_light, near, far);
      arriving = through ? lit.baked.direct_at(i, p + light.to_light * near) : light.illuminance;
      if (!through) far = near;
    } else {
      arriving = lit.baked.direct_at(i, p);
      if (air.drops > 0) arriving = arriving * fading(model, lit.baked.nearest(p), light);
    }
    if (arriving == Vec3f()) continue;
    arriving *= float(std::exp(-fog.turned_depth(Vec3(p + light.to_light * near), Vec3(light.to_light), double(far - near))));
    sum += arriving * air.phase(double(dot(light.to_light, direction)));
  }
  return sum;
}

}  // namespace rubble
