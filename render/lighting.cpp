#include "render/lighting.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {

namespace {

constexpr double kRadPerDeg = portable::kPi / 180;

// Illuminance of a clear sky as a share of the sun's: 10-20 klx beside 60-100 klx.
constexpr float kSkyShare = 0.20f;
// Without a sun it is dusk: civil twilight ends near 3 lx.
constexpr float kDuskSky = 0.004f;  // unit: klx

Sky make_sky(const LightSpec& spec, const Vec3f& axis) {
  Sky sky;
  const bool sunny = spec.type == LightType::directional;
  const float illuminance = sunny ? kSkyShare * float(spec.intensity) : kDuskSky;
  const float mean = illuminance / float(portable::kPi);
  sky.sun_direction = sunny ? -axis : Vec3f(0, 0, 1);
  const float height = std::clamp(sky.sun_direction.z, 0.0f, 1.0f);
  const float low = 1 - std::min(1.0f, height * 3);  // 1 when the sun is at the horizon
  sky.zenith = Vec3f(0.40f, 0.64f, 1.06f) * (mean * (1 - 0.35f * low));
  sky.horizon = Vec3f(1.85f, 2.02f, 2.22f - 0.5f * low) * mean;
  sky.glow = sunny ? Vec3f(1.5f, 1.3f - 0.2f * low, 1.0f - 0.4f * low) * mean : Vec3f();
  return sky;
}

}  // namespace

Vec3f Sky::radiance(const Vec3f& d) const {
  if (d.z < 0) return {};
  const float level = (1 - d.z) * (1 - d.z);
  const float near_sun = std::max(dot(d, sun_direction), 0.0f);
  const float n2 = near_sun * near_sun, n4 = n2 * n2, n8 = n4 * n4;
  return zenith + (horizon - zenith) * (level * level) + glow * n8;
}

LightModel::Sample LightModel::at(const Vec3f& point) const {
  if (type == LightType::directional) return {-axis, colour, 1e9f};
  const Vec3f offset = position - point;
  const float d2 = std::max(dot(offset, offset), 1e-6f);
  const float d = std::sqrt(d2);
  const Vec3f to_light = offset * (1 / d);
  float cone = 1;
  if (type == LightType::spot) {
    const float t = (dot(-to_light, axis) - cos_outer) / (cos_inner - cos_outer);
    const float c = std::clamp(t, 0.0f, 1.0f);
    cone = c * c * (3 - 2 * c);
  }
  return {to_light, colour * (cone / d2), d};
}

LightModel make_light_model(const LightSpec& spec) {
  LightModel model;
  model.type = spec.type;
  model.position = Vec3f(spec.position);
  const Quat turn = portable::quat_from_rpy(
      spec.rpy_deg.x * kRadPerDeg, spec.rpy_deg.y * kRadPerDeg, spec.rpy_deg.z * kRadPerDeg);
  model.axis = Vec3f(turn.rotate({1, 0, 0}));
  const float intensity = float(spec.intensity);
  // Sunlight is a little warm; both colours have the luminance of white (Rec. 709 weights).
  const bool sunny = spec.type == LightType::directional;
  const Vec3f tint = sunny ? Vec3f(1.09f, 0.99f, 0.85f) : Vec3f(1.07f, 0.995f, 0.86f);
  model.colour = tint * (intensity / dot(tint, Vec3f(0.2126f, 0.7152f, 0.0722f)));
  const double half = 0.5 * spec.cone_deg * kRadPerDeg;
  model.cos_outer = float(portable::cos(half));
  model.cos_inner = float(portable::cos(half * 0.85));
  model.sky = make_sky(spec, model.axis);
  return model;
}

}  // namespace rubble
