#include "render/lighting/lighting.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "render/sky/atmosphere.h"

namespace rubble {

namespace {

constexpr double kRadPerDeg = portable::kPi / 180;

// Without a sun it is dusk: civil twilight ends near 3 lx.
constexpr float kDuskSky = 0.004f;  // unit: klx
constexpr double kDuskElevation = -6;
constexpr double kLeastSun = 2;  // degrees; a directional light's colour is that of a sun this high

float luminance_of(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

}  // namespace

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
  if (spec.type == LightType::sun) {
    model.type = LightType::directional;
    model.axis = -sun_direction(spec.elevation_deg, spec.azimuth_deg);
    model.colour = sun_illuminance(spec.elevation_deg);
    return model;
  }
  // A halogen lamp's warm white, or the sun's colour; of the luminance that was asked for.
  const Vec3f tint = spec.type == LightType::directional
                         ? sun_illuminance(std::max(elevation_of(-model.axis), kLeastSun))
                         : Vec3f(1.07f, 0.995f, 0.86f);
  model.colour = tint * (float(spec.intensity) / luminance_of(tint));
  const double half = 0.5 * spec.cone_deg * kRadPerDeg;
  model.cos_outer = float(portable::cos(half));
  model.cos_inner = float(portable::cos(half * 0.85));
  return model;
}

LightModel place_light(const CarriedLight& light, const Pose& world_from_body) {
  const Pose world_from_light = world_from_body * light.body_from_light;
  LightSpec spot;
  spot.type = LightType::spot;
  spot.intensity = 1e-3 * light.intensity_cd;
  spot.position = world_from_light.translation;
  spot.cone_deg = light.cone_deg;
  LightModel model = make_light_model(spot);
  model.axis = Vec3f(world_from_light.rotation.rotate({1, 0, 0}));
  return model;
}

LightSet LightSet::without_carried() const {
  LightSet set = *this;
  set.lights.resize(first_carried());
  set.carried = 0;
  return set;
}

LightSet make_lights(const Scene& scene) {
  const std::size_t count = 1 + scene.more_lights.size() + scene.carried_lights.size();
  if (count > kMostLights)
    throw RunError("a scene has at most " + std::to_string(kMostLights) + " lights, this one " + std::to_string(count));
  LightSet set;
  set.lights.push_back(make_light_model(scene.light));
  for (const LightSpec& spec : scene.more_lights) set.lights.push_back(make_light_model(spec));
  for (const CarriedLight& carried : scene.carried_lights)
    set.lights.push_back(place_light(carried, scene.instances[carried.instance].world_from_body));
  set.carried = scene.carried_lights.size();
  for (const LightSpec& spec : scene.far_lights) set.far.push_back(make_light_model(spec));
  const LightModel& main = set.lights.front();
  if (scene.light.type == LightType::sun) {
    SkyLight sky = make_sky_light(scene.sky, scene.light.elevation_deg, -main.axis, scene.seed);
    set.sky = std::move(sky.sky), set.lights.front().colour = sky.beam;
  } else if (scene.light.type == LightType::directional) {
    const double elevation = std::max(elevation_of(-main.axis), kLeastSun);
    const float share = float(scene.light.intensity) / luminance_of(sun_illuminance(elevation));
    set.sky = make_clear_sky(elevation, -main.axis, std::max(share, 1e-6f));
  } else {
    set.sky = make_clear_sky(kDuskElevation, {1, 0, 0}, 1);
    const float scale = kDuskSky / (float(portable::kPi) * luminance_of(set.sky.mean));
    for (Vec3f& value : set.sky.map) value *= scale;
    set.sky.mean *= scale, set.sky.horizon *= scale;
  }
  if (main.type == LightType::directional && main.axis.z < 0.01f)
    set.sky.sun_radiance = main.colour * (1 / kSunSolidAngle);
  return set;
}

}  // namespace rubble
