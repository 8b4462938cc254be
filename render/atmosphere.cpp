#include "render/atmosphere.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

constexpr double kGround = 6360e3, kTop = 6420e3;  // radii; unit: m
constexpr double kAirHeight = 8000, kHazeHeight = 1200;
// Per metre at the ground, at 680, 550 and 440 nm.
const Vec3 kAir(5.802e-6, 13.558e-6, 33.1e-6);
constexpr double kHazeScattering = 8e-6, kHazeExtinction = 8.9e-6;
const Vec3 kOzone(0.650e-6, 1.881e-6, 0.085e-6);
constexpr double kHazeForward = 0.76;   // asymmetry of its phase function
constexpr double kOuterKlx = 128;       // sunlight outside the atmosphere
const Vec3 kSunColour(1.00, 1.00, 0.98);
constexpr double kPi = 3.14159265358979323846;
constexpr double kManyTimes = 0.55;     // light scattered again, as a share of that scattered once
constexpr double kNightSky = 1.5e-6;    // airglow and stars; unit: kcd/m2
constexpr double kSunRadius = 0.267 * kPi / 180;

struct Densities {
  double air, haze, ozone;
};

Densities densities_at(double height) {
  const double h = std::max(height, 0.0);
  return {std::exp(-h / kAirHeight), std::exp(-h / kHazeHeight),
          std::max(0.0, 1 - std::fabs(h - 25000) / 15000)};
}

// Distance along a ray to the sphere of radius r around the earth's middle, from inside it.
double leave(const Vec3& p, const Vec3& d, double r) {
  const double b = dot(p, d), c = dot(p, p) - r * r;
  return -b + std::sqrt(std::max(0.0, b * b - c));
}

bool meets_ground(const Vec3& p, const Vec3& d) {
  const double b = dot(p, d);
  return b < 0 && b * b - (dot(p, p) - kGround * kGround) > 0;
}

Vec3 pass(const Densities& depth) {
  const Vec3 tau = kAir * depth.air +
                   Vec3(1, 1, 1) * (kHazeExtinction * depth.haze) + kOzone * depth.ozone;
  return {std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z)};
}

Densities depth_along(const Vec3& p, const Vec3& d, double length) {
  constexpr int kSteps = 24;
  Densities sum{0, 0, 0};
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 q = p + d * (length * (i + 0.5) / kSteps);
    const Densities here = densities_at(norm(q) - kGround);
    const double step = length / kSteps;
    sum.air += here.air * step, sum.haze += here.haze * step, sum.ozone += here.ozone * step;
  }
  return sum;
}

Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace

Vec3f sun_illuminance(double elevation_deg) {
  const double e = elevation_deg * kPi / 180;
  const Vec3 p(0, 0, kGround + 2), d(std::cos(e), 0, std::sin(e));
  // The share of the disc above the horizon, as if the disc were a square.
  const double above = std::clamp(0.5 + 0.5 * e / kSunRadius, 0.0, 1.0);
  if (above <= 0) return {};
  const Vec3 level(std::cos(std::max(e, 0.0)), 0, std::sin(std::max(e, 0.0)));
  const Vec3 left = pass(depth_along(p, level, leave(p, level, kTop)));
  return Vec3f(times(left, kSunColour) * (kOuterKlx * above));
}

Vec3f clear_sky_radiance(const Vec3f& direction, const Vec3f& to_sun) {
  constexpr int kSteps = 32;
  const Vec3 eye(0, 0, kGround + 2), sun(to_sun);
  const Vec3 d = normalized(Vec3(double(direction.x), double(direction.y),
                                 std::max(double(direction.z), 0.0)));
  const double length = leave(eye, d, kTop), c = dot(d, sun), g = kHazeForward;
  const double air_phase = 3 / (16 * kPi) * (1 + c * c);
  const double haze_phase = 3 / (8 * kPi) * (1 - g * g) * (1 + c * c) /
                            ((2 + g * g) * std::pow(1 + g * g - 2 * g * c, 1.5));
  Densities depth{0, 0, 0};
  Vec3 once, again;
  for (int i = 0; i < kSteps; ++i) {
    // Steps that grow, since the air is thickest at the start of a level ray.
    const auto at = [&](double k) { return length * (k / kSteps) * (k / kSteps); };
    const double step = at(i + 1) - at(i);
    const Vec3 p = eye + d * at(i + 0.5);
    const Densities here = densities_at(norm(p) - kGround);
    Densities middle = depth;
    middle.air += here.air * step / 2, middle.haze += here.haze * step / 2;
    middle.ozone += here.ozone * step / 2;
    depth.air += here.air * step, depth.haze += here.haze * step, depth.ozone += here.ozone * step;
    const Vec3 through = pass(middle);
    const Vec3 scattered = kAir * here.air * air_phase +
                           Vec3(1, 1, 1) * (kHazeScattering * here.haze * haze_phase);
    const Vec3 evenly = (kAir * here.air + Vec3(1, 1, 1) * (kHazeScattering * here.haze)) *
                        (1 / (4 * kPi));
    if (!meets_ground(p, sun)) {
      const Vec3 lit = pass(depth_along(p, sun, leave(p, sun, kTop)));
      once += times(times(scattered, through), lit) * step;
      again += times(times(evenly, through), lit) * (step * kManyTimes);
    }
  }
  const Vec3 sum = times(once + again, kSunColour) * kOuterKlx;
  return Vec3f(sum + Vec3(0.8, 0.9, 1.2) * kNightSky);
}

}  // namespace rubble
