#include "bench/images/sky_panorama.h"

#include "kernel/base/portable_math.h"

namespace rubble {

SkyPanorama make_sky_panorama(const Sky& sky, int height) {
  SkyPanorama out{2 * height, height, {}};
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const Vec3f way = sun_direction(90 - 180 * (y + 0.5) / out.height, 180 - 360 * (x + 0.5) / out.width);
      const Vec3f light = sky.radiance(way);
      out.rgb.insert(out.rgb.end(), {light.x, light.y, light.z});
    }
  }
  return out;
}

Vec3 SkyPanorama::mean() const {
  constexpr double kPi = portable::kPi;
  Vec3 sum;
  for (int y = 0; y < height; ++y) {
    const portable::SinCos elevation = portable::sincos(kPi / 2 - kPi * (y + 0.5) / height);
    if (elevation.sin <= 0) break;
    const double weight = elevation.sin * elevation.cos * (kPi / height) * (2 * kPi / width);
    for (int x = 0; x < width; ++x) {
      const float* p = &rgb[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3];
      sum += Vec3(double(p[0]), double(p[1]), double(p[2])) * weight;
    }
  }
  return sum * (1 / kPi);
}

}  // namespace rubble
