#include "render/sky/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr double kGround = 6360e3, kTop = 6420e3;  // radii; unit: m
constexpr double kAirHeight = 8000, kHazeHeight = 1200;
// Per metre at the ground, at 615, 550 and 465 nm, about where the primaries of sRGB are. (Taken at 680
// nm, as is common, red escapes the ozone, and the zenith of dusk turns purple instead of blue.)
const Vec3 kAir(8.67e-6, 13.558e-6, 26.5e-6);
const Vec3 kHaze(2.52e-5, 2.92e-5, 3.63e-5);  // what it takes away
constexpr double kHazeScatters = 0.94;        // the share of this that it scatters
const Vec3 kOzone(2.5e-6, 1.881e-6, 0.25e-6);
constexpr double kHazeForward = 0.76;   // asymmetry of its phase function
constexpr double kOuterKlx = 133;       // sunlight outside the atmosphere
const Vec3 kSunColour(1.00, 1.00, 0.98);
constexpr double kGroundAlbedo = 0.25;
constexpr double kTwiceAndMore = 0.25;  // of light scattered evenly, the share scattered once more
constexpr double kNightSky = 1.5e-6;    // airglow and stars; unit: kcd/m2
constexpr double kSunRadius = 0.267 * portable::kPi / 180;

struct Densities {
  double air, haze, ozone;
};

Densities densities_at(double height, double haze) {
  const double h = std::max(height, 0.0);
  return {quick::exp(-h / kAirHeight), haze * quick::exp(-h / kHazeHeight),
          std::max(0.0, 1 - std::fabs(h - 25000) / 15000)};
}

// Distance along a ray to the sphere of radius r around the earth's middle, from inside it.
double leave(const Vec3& p, const Vec3& d, double r) {
  const double b = dot(p, d), c = dot(p, p) - r * r;
  return -b + std::sqrt(std::max(0.0, b * b - c));
}

Vec3 pass(const Densities& depth) {
  const Vec3 tau = kAir * depth.air + kHaze * depth.haze + kOzone * depth.ozone;
  return {quick::exp(-tau.x), quick::exp(-tau.y), quick::exp(-tau.z)};
}

Densities depth_along(const Vec3& p, const Vec3& d, double length, double haze) {
  const int steps = haze > 1 ? 192 : 24;  // thick haze lies within the lowest of a few steps
  Densities sum{0, 0, 0};
  for (int i = 0; i < steps; ++i) {
    const Vec3 q = p + d * (length * (i + 0.5) / steps);
    const Densities here = densities_at(norm(q) - kGround, haze);
    const double step = length / steps;
    sum.air += here.air * step, sum.haze += here.haze * step, sum.ozone += here.ozone * step;
  }
  return sum;
}

// The table's axes: radii from the ground to the top, and cosines of the sun's zenith angle from the
// horizon of that radius up, both finer at their low end.
double radius_of(double t) { return kGround + 2 + t * t * (kTop - kGround - 2); }
double horizon_cosine(double r) {
  const double s = kGround / r;
  return -std::sqrt(std::max(0.0, 1 - s * s));
}
double cosine_of(double t, double r) {
  const double low = horizon_cosine(r);
  return low + t * t * (1 - low);
}

// Mean of exp(-x) from 0 to tau.
double mean_pass(double tau) { return tau < 1e-4 ? 1 - 0.5 * tau : (1 - quick::exp(-tau)) / tau; }

Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace

Vec3f sun_illuminance(double elevation_deg, double haze) {
  const double e = elevation_deg * portable::kPi / 180;
  const Vec3 p(0, 0, kGround + 2), d(quick::cos(e), 0, quick::sin(e));
  // The share of the disc above the horizon, as if the disc were a square.
  const double above = std::clamp(0.5 + 0.5 * e / kSunRadius, 0.0, 1.0);
  if (above <= 0) return {};
  const Vec3 level(quick::cos(std::max(e, 0.0)), 0, quick::sin(std::max(e, 0.0)));
  const Vec3 left = pass(depth_along(p, level, leave(p, level, kTop), haze));
  return Vec3f(times(left, kSunColour) * (kOuterKlx * above));
}

ClearSky::ClearSky(const Vec3f& to_sun, double haze) : sun_(to_sun), haze_(haze) {
  for (int h = 0; h < kHeights; ++h) {
    const double r = radius_of(double(h) / (kHeights - 1));
    for (int c = 0; c < kCosines; ++c) {
      const double mu = cosine_of(double(c) / (kCosines - 1), r);
      const Vec3 p(0, 0, r), d(std::sqrt(std::max(0.0, 1 - mu * mu)), 0, mu);
      Densities depth = depth_along(p, d, leave(p, d, kTop), haze);
      depth.haze *= haze > 1 ? 1 - kHazeScatters * kHazeForward * kHazeForward : 1;
      sunlight_.push_back(pass(depth));
    }
  }
  // The mean over all directions: those of equal solid angle in the upper half, and the lit ground.
  constexpr int kRings = 8, kSides = 8;
  const double azimuth = quick::atan2(sun_.y, sun_.x);
  Vec3 sky, level;
  for (int i = 0; i < kRings; ++i) {
    const double z = (i + 0.5) / kRings, flat = std::sqrt(1 - z * z);
    for (int j = 0; j < kSides; ++j) {  // one half: the other is its mirror image
      const double a = azimuth + portable::kPi * (j + 0.5) / kSides;
      const Scattered s = scatter({flat * quick::cos(a), flat * quick::sin(a), z});
      sky += s.sun * (1.0 / (kRings * kSides));
      level += s.sun * (2 * z / (kRings * kSides));
    }
  }
  const Vec3 direct = sunlight_at({0, 0, kGround + 2}) * (kOuterKlx * std::max(0.0, sun_.z) / portable::kPi);
  const Vec3 ground = (level + direct) * kGroundAlbedo;
  around_ = (sky + ground) * (0.5 / (1 - kTwiceAndMore));
}

Vec3 ClearSky::sunlight_at(const Vec3& p) const {
  const double r = norm(p), mu = dot(p, sun_) / r, low = horizon_cosine(r);
  // The share of the disc above the horizon, as if the disc were a square.
  const double above = std::clamp(0.5 + 0.5 * (mu - low) / kSunRadius, 0.0, 1.0);
  if (above <= 0) return {};
  const double y = std::sqrt(std::clamp((r - kGround) / (kTop - kGround), 0.0, 1.0)) * (kHeights - 1);
  const double x = std::sqrt(std::clamp((mu - low) / (1 - low), 0.0, 1.0)) * (kCosines - 1);
  const int i = std::min(int(y), kHeights - 2), j = std::min(int(x), kCosines - 2);
  const double v = y - i, u = x - j;
  const Vec3* t = sunlight_.data() + i * kCosines + j;
  const Vec3 lower = t[0] + (t[1] - t[0]) * u;
  return (lower + (t[kCosines] + (t[kCosines + 1] - t[kCosines]) * u - lower) * v) * above;
}

ClearSky::Scattered ClearSky::scatter(const Vec3& d) const {
  constexpr int kSteps = 40;
  const Vec3 eye(0, 0, kGround + 2);
  const double length = leave(eye, d, kTop), c = dot(d, sun_), g = kHazeForward;
  const double air_phase = 3 / (16 * portable::kPi) * (1 + c * c);
  const double haze_phase = 3 / (8 * portable::kPi) * (1 - g * g) * (1 + c * c) /
                            ((2 + g * g) * quick::pow(1 + g * g - 2 * g * c, 1.5));
  // Thick haze scatters its own light again, mostly straight on: what goes on within the forward peak, the
  // share g^2, is not lost on the way (delta scaling, Joseph, Wiscombe and Weinman 1976).
  const double kept = haze_ > 1 ? 1 - kHazeScatters * g * g : 1;
  Densities depth{0, 0, 0};
  Scattered sum;
  for (int i = 0; i < kSteps; ++i) {
    // Steps that grow, since the air is thickest at the start of a level ray.
    const auto at = [&](double k) { return length * (k / kSteps) * (k / kSteps); };
    const double step = at(i + 1) - at(i);
    const Vec3 p = eye + d * at(i + 0.5);
    const Densities here = densities_at(norm(p) - kGround, haze_);
    const Vec3 air = kAir * here.air, haze = kHaze * (kHazeScatters * here.haze);
    // The light that a step adds, weakened on its way by the step itself: exact for even air.
    const Vec3 tau = (kAir * here.air + kHaze * (here.haze * kept) + kOzone * here.ozone) * step;
    const Vec3 left = times(pass(depth), Vec3(mean_pass(tau.x), mean_pass(tau.y), mean_pass(tau.z)));
    sum.sun += times(times(air * air_phase + haze * haze_phase, left), sunlight_at(p)) *
               (step * kOuterKlx);
    sum.even += times(air + haze, left) * step;
    depth.air += here.air * step, depth.haze += here.haze * (step * kept), depth.ozone += here.ozone * step;
  }
  return sum;
}

Vec3f ClearSky::radiance(const Vec3f& direction) const {
  const Vec3 d = normalized(Vec3(double(direction.x), double(direction.y),
                                 std::max(double(direction.z), 0.0)));
  const Scattered s = scatter(d);
  return Vec3f(s.sun + times(s.even, around_) + Vec3(0.8, 0.9, 1.2) * kNightSky);
}

Vec3f night_sky() { return Vec3f(Vec3(0.8, 0.9, 1.2) * kNightSky); }

}  // namespace rubble
