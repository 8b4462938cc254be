#include "render/lighting/sky.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/base/portable_math.h"
#include "render/sky/atmosphere.h"
#include "render/sky/clouds.h"
#include "render/sky/sky_model.h"

namespace rubble {

namespace {

constexpr double kRadiansPerDegree = portable::kPi / 180;

// The map's texel centres and their directions.
Vec3f direction_of(int x, int y, int side) {
  const float u = (float(x) + 0.5f) / float(side) * 2 - 1, v = (float(y) + 0.5f) / float(side) * 2 - 1;
  const float px = (u + v) * 0.5f, py = (u - v) * 0.5f;
  return normalized(Vec3f(px, py, 1 - std::fabs(px) - std::fabs(py)));
}

// The clear sky by elevation and by azimuth away from the sun, from which the map is filled: the sky
// is the same on both sides of the sun.
class SkyTable {
 public:
  SkyTable(double sun_elevation_deg, double haze) {
    const ClearSky sky(sun_direction(sun_elevation_deg, 0), haze);
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

// The map of a function of direction.
template <typename RadianceOf>
Sky draw_sky(int side, const Vec3f& to_sun, const RadianceOf& radiance_of) {
  Sky sky;
  sky.side = side;
  sky.sun_direction = to_sun;
  float weights = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Vec3f d = direction_of(x, y, side);
      const Vec3f value = radiance_of(d);
      sky.map.push_back(value);
      // A texel's solid angle goes with the cube of z of the flat octahedron it lies on.
      const float flat = std::fabs(d.x) + std::fabs(d.y) + d.z;
      const float weight = flat * flat * flat * d.z;
      sky.mean += value * weight, weights += weight;
      const bool border = x == 0 || y == 0 || x == side - 1 || y == side - 1;
      if (border) sky.horizon += value * (1.0f / float(4 * side - 4));
    }
  }
  sky.mean *= 1 / weights;
  return sky;
}

void scale_sky(Sky& sky, float scale) {
  for (Vec3f& value : sky.map) value *= scale;
  sky.mean *= scale, sky.horizon *= scale;
}

float luminance_over(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

// The clear sky with `haze` times the haze, as a function of direction.
class ClearDome {
 public:
  ClearDome(double sun_elevation_deg, const Vec3f& to_sun, double haze)
      : table_(sun_elevation_deg, haze),
        azimuth_(portable::atan2(double(to_sun.y), double(to_sun.x)) / kRadiansPerDegree) {}
  Vec3f operator()(const Vec3f& d) const {
    double off = portable::atan2(double(d.y), double(d.x)) / kRadiansPerDegree - azimuth_;
    off -= 360 * std::floor((off + 180) / 360);
    return table_.at(elevation_of(d), off);
  }

 private:
  SkyTable table_;
  double azimuth_;
};

}  // namespace

Vec3f sun_direction(double elevation_deg, double azimuth_deg) {
  const portable::SinCos e = portable::sincos(elevation_deg * kRadiansPerDegree);
  const portable::SinCos a = portable::sincos(azimuth_deg * kRadiansPerDegree);
  return {float(e.cos * a.cos), float(e.cos * a.sin), float(e.sin)};
}

double elevation_of(const Vec3f& to_sun) {
  return portable::asin(std::clamp(double(to_sun.z), -1.0, 1.0)) / kRadiansPerDegree;
}

Vec3f Sky::radiance(const Vec3f& d) const {
  if (d.z < 0) return {};
  const float flat = 1 / (std::fabs(d.x) + std::fabs(d.y) + d.z);
  const float px = d.x * flat, py = d.y * flat;
  const float wide = float(side);
  const float fx = std::clamp((px + py) * 0.5f * wide + 0.5f * wide - 0.5f, 0.0f, wide - 1.001f);
  const float fy = std::clamp((px - py) * 0.5f * wide + 0.5f * wide - 0.5f, 0.0f, wide - 1.001f);
  const int x = int(fx), y = int(fy);
  const float u = fx - float(x), v = fy - float(y);
  const Vec3f* p = map.data() + y * side + x;
  const Vec3f low = p[0] + (p[1] - p[0]) * u;
  return low + (p[side] + (p[side + 1] - p[side]) * u - low) * v;
}

Sky make_clear_sky(double sun_elevation_deg, const Vec3f& to_sun, float scale) {
  const ClearDome dome(sun_elevation_deg, to_sun, 1);
  return draw_sky(Sky::kSide, to_sun, [&](const Vec3f& d) { return dome(d) * scale; });
}

namespace {

// The sun, or the moon in its place.
struct SkySource {
  double elevation_deg;
  Vec3f direction;
};

SkyLight make_moonlit(const SkySource& moon) {
  const ClearDome clear(moon.elevation_deg, moon.direction, 1);
  const auto radiance = [&](const Vec3f& d) {
    return (clear(d) - night_sky()) * kMoonOverSun + night_sky();
  };
  return {draw_sky(Sky::kSide, moon.direction, radiance),
          sun_illuminance(moon.elevation_deg) * kMoonOverSun};
}

SkyLight make_overcast(const SkySource& sun) {
  const Sky dusk = make_clear_sky(std::min(sun.elevation_deg, 0.0), sun.direction, 1);
  const float klx = overcast_illuminance(sun.elevation_deg, dusk.mean.y * portable::kPiF);
  return {draw_sky(Sky::kSide, sun.direction, [&](const Vec3f& d) { return overcast_radiance(d.z, klx); }),
          {}};
}

SkyLight make_cloudy(const SkySource& sun, double cover, std::uint64_t seed) {
  const Vec3f beam = sun_illuminance(sun.elevation_deg);
  const Sky open = make_clear_sky(sun.elevation_deg, sun.direction, 1);
  const ClearDome clear(sun.elevation_deg, sun.direction, 1);
  const CloudLayer clouds(cover, seed, sun.direction, beam, open.mean * portable::kPiF);
  const auto radiance = [&](const Vec3f& d) { return clouds.cover(d, clear(d), open.horizon); };
  return {draw_sky(Sky::kFineSide, sun.direction, radiance), beam * clouds.beam_share(sun.direction)};
}

SkyLight make_hazy(const SkySource& sun) {
  const Vec3f beam = sun_illuminance(sun.elevation_deg, kHazyDay);
  Sky sky = draw_sky(Sky::kSide, sun.direction, ClearDome(sun.elevation_deg, sun.direction, kHazyDay));
  const Vec3f lost = sun_illuminance(sun.elevation_deg) - beam;
  const Vec3f clear = make_clear_sky(sun.elevation_deg, sun.direction, 1).mean * portable::kPiF;
  scale_sky(sky, hazy_illuminance(clear.y, lost.y, sun.direction.z) / (sky.mean.y * portable::kPiF));
  return {std::move(sky), beam};
}

// The colours of the clear sky, with the luminances of the standard; together as much light.
SkyLight make_cie_clear(const SkySource& sun) {
  const ClearDome clear(sun.elevation_deg, sun.direction, 1);
  Sky sky = draw_sky(Sky::kSide, sun.direction, [&](const Vec3f& d) {
    const Vec3f colour = clear(d);
    const float ratio = cie_clear_ratio(d.z, sun.direction.z, dot(d, sun.direction));
    return colour * (ratio / luminance_over(colour));
  });
  const Vec3f mean = make_clear_sky(sun.elevation_deg, sun.direction, 1).mean;
  scale_sky(sky, luminance_over(mean) / luminance_over(sky.mean));
  return {std::move(sky), sun_illuminance(sun.elevation_deg)};
}

}  // namespace

SkyLight make_sky_light(const SkySpec& spec, double sun_elevation_deg, const Vec3f& to_sun,
                        std::uint64_t seed) {
  const SkySource sun{sun_elevation_deg, to_sun};
  switch (spec.type) {
    case SkyType::hazy: return make_hazy(sun);
    case SkyType::cloudy: return make_cloudy(sun, spec.cloud_cover, seed);
    case SkyType::overcast: return make_overcast(sun);
    case SkyType::moonlit: return make_moonlit(sun);
    case SkyType::city_night:
      return {draw_sky(Sky::kSide, to_sun, [](const Vec3f& d) { return city_glow(d.z); }), {}};
    case SkyType::cie_clear:
      if (to_sun.z > 0) return make_cie_clear(sun);
      break;
    case SkyType::clear: break;
  }
  return {make_clear_sky(sun_elevation_deg, to_sun, 1), sun_illuminance(sun_elevation_deg)};
}

}  // namespace rubble
