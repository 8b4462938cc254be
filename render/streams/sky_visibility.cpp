#include <cmath>

#include "kernel/base/portable_math.h"
#include "render/scene/seen_surface.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

constexpr int kSkyRays = 64;
constexpr double kLift = 5e-4;     // rays start this far off the surface; unit: m
constexpr float kFarthest = 1e4f;  // unit: m

// Evenly spread and cosine-weighted about +Z, so that their mean is the sky view factor: Malley's
// method over a golden-ratio sequence.
const std::vector<Vec3>& sky_directions() {
  static const std::vector<Vec3> directions = [] {
    std::vector<Vec3> out;
    for (int i = 0; i < kSkyRays; ++i) {
      const double u = (i + 0.5) / kSkyRays, turns = i * 0.6180339887498949;
      const portable::SinCos a = portable::sincos(2 * portable::kPi * (turns - std::floor(turns)));
      out.push_back({std::sqrt(u) * a.cos, std::sqrt(u) * a.sin, std::sqrt(1 - u)});
    }
    return out;
  }();
  return directions;
}

// From 0 to 1, unlike for neighbours (Jimenez 2014).
double turn_of_pixel(int u, int v) {
  const double x = 0.06711056 * u + 0.00583715 * v, y = 52.9829189 * (x - std::floor(x));
  return y - std::floor(y);
}

void make_sky_visibility(const SeenSurface& seen, float* pixel) {
  const Vec3 normal = seen.normal();
  const Vec3 side = std::fabs(normal.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 a = normalized(cross(side, normal)), b = cross(normal, a);
  const portable::SinCos t = portable::sincos(2 * portable::kPi * turn_of_pixel(seen.u, seen.v));
  const Vec3 x = a * t.cos + b * t.sin, y = b * t.cos - a * t.sin;
  const Vec3f from(seen.point + normal * kLift);
  int open = 0;
  for (const Vec3& d : sky_directions()) {
    const Vec3f ray(x * d.x + y * d.y + normal * d.z);
    open += ray.z > 0 && !seen.blocked(from, ray, kFarthest);
  }
  *pixel = float(open) / kSkyRays;
}

}  // namespace

ImageStream sky_visibility_stream() {
  ImageStream stream;
  stream.name = "sky_visibility";
  stream.meaning =
      "Sky view factor: light of a uniform sky on the surface, relative to that on open level ground; 1: no "
      "surface. It takes 64 rays per pixel, about 5 s for 1 million pixels on two cores.";
  stream.make = make_sky_visibility;
  stream.nothing = 1;
  stream.casts_rays = true;
  return stream;
}

}  // namespace rubble
