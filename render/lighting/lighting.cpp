#include "render/lighting/lighting.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "render/lighting/atmosphere.h"

namespace rubble {

namespace {

constexpr double kRadPerDeg = portable::kPi / 180;

// Without a sun it is dusk: civil twilight ends near 3 lx.
constexpr float kDuskSky = 0.004f;  // unit: klx
constexpr double kDuskElevation = -6;
constexpr double kLeastSun = 2;  // degrees; a directional light's colour is that of a sun this high

Vec3f sun_direction(double elevation_deg, double azimuth_deg) {
  const portable::SinCos e = portable::sincos(elevation_deg * kRadPerDeg);
  const portable::SinCos a = portable::sincos(azimuth_deg * kRadPerDeg);
  return {float(e.cos * a.cos), float(e.cos * a.sin), float(e.sin)};
}

double elevation_of(const Vec3f& to_sun) {
  return portable::asin(std::clamp(double(to_sun.z), -1.0, 1.0)) / kRadPerDeg;
}

float luminance_of(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

// The map's texel centres and their directions.
Vec3f direction_of(int x, int y) {
  const float u = (float(x) + 0.5f) / Sky::kSide * 2 - 1, v = (float(y) + 0.5f) / Sky::kSide * 2 - 1;
  const float px = (u + v) * 0.5f, py = (u - v) * 0.5f;
  return normalized(Vec3f(px, py, 1 - std::fabs(px) - std::fabs(py)));
}

// The clear sky by elevation and by azimuth away from the sun, from which the map is filled: the sky
// is the same on both sides of the sun.
class SkyTable {
 public:
  SkyTable(double sun_elevation_deg) {
    const ClearSky sky(sun_direction(sun_elevation_deg, 0));
    for (int e = 0; e < kElevations; ++e) {
      const double t = double(e) / (kElevations - 1);
      for (int a = 0; a < kAzimuths; ++a)
        values_.push_back(
            sky.radiance(sun_direction(90 * t * t, 180.0 * a / (kAzimuths - 1))));
    }
  }
  Vec3f at(double elevation_deg, double azimuth_deg) const {
    const double y = std::sqrt(std::clamp(elevation_deg / 90, 0.0, 1.0)) * (kElevations - 1);
    const double x = std::clamp(std::fabs(azimuth_deg) / 180, 0.0, 1.0) * (kAzimuths - 1);
    const int x0 = std::min(int(x), kAzimuths - 2), y0 = std::min(int(y), kElevations - 2);
    const float u = float(x - x0), v = float(y - y0);
    const Vec3f* p = values_.data() + y0 * kAzimuths + x0;
    const Vec3f low = p[0] + (p[1] - p[0]) * u;
    return low + (p[kAzimuths] + (p[kAzimuths + 1] - p[kAzimuths]) * u - low) * v;
  }

 private:
  static constexpr int kElevations = 32, kAzimuths = 25;
  std::vector<Vec3f> values_;
};

Sky make_sky(double sun_elevation_deg, const Vec3f& to_sun, float scale) {
  Sky sky;
  sky.sun_direction = to_sun;
  const SkyTable table(sun_elevation_deg);
  const double sun_azimuth = portable::atan2(double(to_sun.y), double(to_sun.x)) / kRadPerDeg;
  float weights = 0;
  for (int y = 0; y < Sky::kSide; ++y) {
    for (int x = 0; x < Sky::kSide; ++x) {
      const Vec3f d = direction_of(x, y);
      double off = portable::atan2(double(d.y), double(d.x)) / kRadPerDeg - sun_azimuth;
      off -= 360 * std::floor((off + 180) / 360);
      const Vec3f value = table.at(elevation_of(d), off) * scale;
      sky.map.push_back(value);
      // A texel's solid angle goes with the cube of z of the flat octahedron it lies on.
      const float flat = std::fabs(d.x) + std::fabs(d.y) + d.z;
      const float weight = flat * flat * flat * d.z;
      sky.mean += value * weight, weights += weight;
      const bool border = x == 0 || y == 0 || x == Sky::kSide - 1 || y == Sky::kSide - 1;
      if (border) sky.horizon += value * (1.0f / (4 * Sky::kSide - 4));
    }
  }
  sky.mean *= 1 / weights;
  return sky;
}

}  // namespace

Vec3f Sky::radiance(const Vec3f& d) const {
  if (d.z < 0) return {};
  const float flat = 1 / (std::fabs(d.x) + std::fabs(d.y) + d.z);
  const float px = d.x * flat, py = d.y * flat;
  const float fx = std::clamp((px + py) * 0.5f * kSide + 0.5f * kSide - 0.5f, 0.0f, kSide - 1.001f);
  const float fy = std::clamp((px - py) * 0.5f * kSide + 0.5f * kSide - 0.5f, 0.0f, kSide - 1.001f);
  const int x = int(fx), y = int(fy);
  const float u = fx - float(x), v = fy - float(y);
  const Vec3f* p = map.data() + y * kSide + x;
  const Vec3f low = p[0] + (p[1] - p[0]) * u;
  return low + (p[kSide] + (p[kSide + 1] - p[kSide]) * u - low) * v;
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

LightSet make_lights(const Scene& scene) {
  if (scene.more_lights.size() + 1 > kMostLights)
    throw RunError("a scene has at most " + std::to_string(kMostLights) + " lights, this one " +
                   std::to_string(scene.more_lights.size() + 1));
  LightSet set;
  set.lights.push_back(make_light_model(scene.light));
  for (const LightSpec& spec : scene.more_lights) set.lights.push_back(make_light_model(spec));
  const LightModel& main = set.lights.front();
  if (scene.light.type == LightType::sun) {
    set.sky = make_sky(scene.light.elevation_deg, -main.axis, 1);
  } else if (scene.light.type == LightType::directional) {
    const double elevation = std::max(elevation_of(-main.axis), kLeastSun);
    const float share = float(scene.light.intensity) / luminance_of(sun_illuminance(elevation));
    set.sky = make_sky(elevation, -main.axis, std::max(share, 1e-6f));
  } else {
    set.sky = make_sky(kDuskElevation, {1, 0, 0}, 1);
    const float scale = kDuskSky / (float(portable::kPi) * luminance_of(set.sky.mean));
    for (Vec3f& value : set.sky.map) value *= scale;
    set.sky.mean *= scale, set.sky.horizon *= scale;
  }
  constexpr float kDisc = 6.8e-5f;  // solid angle of the sun; unit: sr
  if (main.type == LightType::directional && main.axis.z < 0.01f)
    set.sky.sun_radiance = main.colour * (1 / kDisc);
  return set;
}

}  // namespace rubble
