// The sky as a map of radiance: the one function of direction that lights surfaces, fast and path traced,
// and that cameras see.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "render/scene/scene.h"

namespace rubble {

// Radiance of the upper half of all directions, on a square map: the octahedron's upper half turned
// by 45 degrees, so that the zenith is in the middle and the horizon along the border.
struct Sky {
  static constexpr int kSide = 96;       // of the map of a smooth sky; unit: texel
  static constexpr int kFineSide = 1024;  // of one with clouds
  int side = kSide;                      // of this map
  std::vector<Vec3f> map;           // rows; unit: kcd/m2
  Vec3f mean;                       // irradiance of level ground over pi
  Vec3f horizon;                    // mean over the horizon
  Vec3f sun_direction{0, 0, 1};     // also below the horizon; of a moonlit night the moon's
  Vec3f sun_radiance;               // of its disc; black without one; unit: kcd/m2

  // direction: unit length, pointing up or level; below the horizon it is black. Without the disc.
  Vec3f radiance(const Vec3f& direction) const;
};

// The clear sky of a sun there, times `scale`.
Sky make_clear_sky(double sun_elevation_deg, const Vec3f& to_sun, float scale);

// Any sky, and the beam of the sun or the moon that goes with it.
struct SkyLight {
  Sky sky;     // without the disc
  Vec3f beam;  // on a facing surface; black: none; unit: klx
};
SkyLight make_sky_light(const SkySpec& spec, double sun_elevation_deg, const Vec3f& to_sun,
                        std::uint64_t seed);

Vec3f sun_direction(double elevation_deg, double azimuth_deg);  // unit length
double elevation_of(const Vec3f& to_sun);                       // unit: degree

}  // namespace rubble
